// SPDX-License-Identifier: BSD-3-Clause
// A mesh with its mass, and the exact penetration of two of them.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "vps/solid.h"
#include "vps_bullet/shape.h"

namespace vps::dynamics {

struct PartMesh {
  Mesh mesh;                ///< in the part's frame P
  bullet::BodyFrame frame;  ///< a body's frame B in P: centre of mass, principal axes
  std::shared_ptr<const Solid> exact;
};

/// Throws LoadError for a mesh without a volume.
PartMesh makePart(Mesh mesh, double density_kg_m3 = 7850);

/// The part with another mass; its inertia scales in proportion, as with another density.
PartMesh withMass(PartMesh part, double mass_kg);

/// The mesh in its body's frame, from which an engine makes a shape.
Mesh bodyMesh(const PartMesh& part);

/// Caches parts by their parameters, since engines share one shape among bodies of one part, and building
/// shapes takes longer than most scenes.
template <typename Make>
const PartMesh& keptPart(std::map<std::vector<double>, PartMesh>& parts, std::vector<double> key, Make make) {
  const auto it = parts.find(key);
  return it != parts.end() ? it->second : parts.emplace(std::move(key), make()).first->second;
}

/// Greatest depth [m] of either part's vertices in the other, by exact distance. If no vertex is inside, the
/// result is minus the least gap of the vertices that lie within the other part's bounding box enlarged by 1
/// mm, or -1e300 if no vertex does.
double penetration_m(const PartMesh& a, const Pose& X_WA, const PartMesh& b, const Pose& X_WB);

}  // namespace vps::dynamics
