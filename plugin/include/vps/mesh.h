// SPDX-License-Identifier: BSD-3-Clause
// Triangle meshes: the form in which every part enters.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "vps/pose.h"

namespace vps {

/// Vertices [m] in the part's frame and triangles, counter-clockwise from outside.
struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct Box {
  Vec3 min = Vec3::Constant(1e300);
  Vec3 max = Vec3::Constant(-1e300);
  void add(const Vec3& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  [[nodiscard]] bool isEmpty() const { return (min.array() > max.array()).any(); }
  [[nodiscard]] Vec3 center() const { return 0.5 * (min + max); }
  [[nodiscard]] Vec3 size() const { return max - min; }
};

/// Of a body with unit density: volume [m^3], centre of mass [m] and inertia about it [m^5], in the mesh's
/// frame.
struct MassProperties {
  double volume_m3 = 0;
  Vec3 com = Vec3::Zero();
  Mat3 inertia_m5 = Mat3::Zero();
};

/// What a mesh is made of; see checkMesh().
struct MeshReport {
  std::size_t degenerate_triangles = 0;
  std::size_t open_edges = 0;          ///< edges with one triangle
  std::size_t non_manifold_edges = 0;  ///< edges with more than two
  std::size_t flipped_edges = 0;       ///< edges whose two triangles disagree on orientation
  std::size_t shells = 0;              ///< connected components
  [[nodiscard]] bool isClosed() const {
    return open_edges == 0 && non_manifold_edges == 0 && flipped_edges == 0;
  }
};

Box bounds(const Mesh& mesh);
double area(const Mesh& mesh);

/// By the divergence theorem; exact for a closed, outward-oriented mesh. O(triangles).
/// Source: Mirtich 1996 in the tetrahedron form of Eberly 2002.
MassProperties massProperties(const Mesh& mesh);

/// The mesh with every vertex moved by X_AB (from B to A).
Mesh transformed(const Mesh& mesh, const Pose& X_AB);

/// Appends b's triangles to a.
void append(Mesh& a, const Mesh& b);

/// Merges vertices that are equal to within tolerance_m (0: to the bit) and drops triangles that collapse.
/// CAD exports repeat vertices for each face or triangle; connectivity needs them shared.
Mesh welded(const Mesh& mesh, double tolerance_m = 0);

/// Counts edges and shells. Expects shared vertices (see welded()).
MeshReport checkMesh(const Mesh& mesh);

/// Refuses what nothing can be built from: no triangles, an index out of range, a coordinate that is not
/// finite, zero area. Throws LoadError naming file and part.
void requireUsable(const Mesh& mesh, const std::string& file, const std::string& part);

/// Primitives with analytic truth, for tests and simple scenes; all centred at the origin, closed, outward.
Mesh makeBox(const Vec3& size_m);
/// Cylinder along z. Vertices lie on the true circle, so flats are inside it by r (1 - cos(pi / segments)).
Mesh makeCylinder(double radius_m, double height_m, int segments);
/// Tube along z: outer and inner radius.
Mesh makeTube(double outer_m, double inner_m, double height_m, int segments);
/// Sphere from a subdivided icosahedron: 20 * 4^level triangles, vertices on the sphere.
Mesh makeSphere(double radius_m, int level);

}  // namespace vps
