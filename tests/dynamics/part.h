// SPDX-License-Identifier: BSD-3-Clause
// A mesh with its mass, and how deep two of them are in each other by exact distance.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "vps/mesh_distance.h"
#include "vps_bullet/shape.h"

namespace vps::dynamics {

struct PartMesh {
  Mesh mesh;                ///< in the part's frame P
  bullet::BodyFrame frame;  ///< a body's frame B in P: centre of mass, principal axes
  std::shared_ptr<const MeshDistance> exact;
};

/// Throws LoadError for a mesh without a volume.
PartMesh makePart(Mesh mesh, double density_kg_m3 = 7850);

/// The same surface with another mass: inertia in proportion, as of another density.
PartMesh withMass(PartMesh part, double mass_kg);

/// The mesh in its body's frame: what an engine makes a shape from.
Mesh bodyMesh(const PartMesh& part);

/// Keeps parts by what they were made from: engines share one shape among bodies of one part, and building
/// shapes takes longer than most scenes.
template <typename Make>
const PartMesh& keptPart(std::map<std::vector<double>, PartMesh>& parts, std::vector<double> key, Make make) {
  const auto it = parts.find(key);
  return it != parts.end() ? it->second : parts.emplace(std::move(key), make()).first->second;
}

/// Greatest depth [m] of either part's vertices in the other, by exact distance; negative: no vertex of one
/// is inside the other, and the least gap of those in the other's box (grown by 1 mm). -1e300 beyond that.
double penetration_m(const PartMesh& a, const Pose& X_WA, const PartMesh& b, const Pose& X_WB);

}  // namespace vps::dynamics
