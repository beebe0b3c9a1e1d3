// SPDX-License-Identifier: BSD-3-Clause
// Triangle meshes, the input for every part: mass, welding, survey and primitives.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "vps/box.h"
#include "vps/export.h"
#include "vps/pose.h"

namespace vps {

/// Vertices [m] in the part's frame and triangles, counter-clockwise from outside.
struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Properties of a body with unit density: volume [m^3], centre of mass [m] and inertia about it [m^5], in
/// the mesh's frame.
struct MassProperties {
  double volume_m3 = 0;
  Vec3 com = Vec3::Zero();
  Mat3 inertia_m5 = Mat3::Zero();
};

/// The composition of a mesh and its faults. checkMesh() fills the members up to `shells`; repairMesh()
/// (mesh_repair.h) fills all.
struct MeshReport {
  std::size_t triangles = 0;
  std::size_t degenerate_triangles = 0;
  /// Triangles beyond the first with the same three corners, in either orientation.
  std::size_t duplicate_triangles = 0;
  std::size_t open_edges = 0;          ///< edges with one triangle
  std::size_t non_manifold_edges = 0;  ///< edges with more than two triangles
  std::size_t flipped_edges = 0;       ///< edges whose two triangles disagree on orientation
  std::size_t shells = 0;              ///< connected components
  [[nodiscard]] bool isClosed() const {
    return open_edges == 0 && non_manifold_edges == 0 && flipped_edges == 0;
  }

  std::size_t joined_corners = 0;  ///< corners moved onto another corner, to close cracks narrower than 2 um
  double joined_m = 0;             ///< greatest distance by which a corner was moved
  std::size_t holes = 0;           ///< groups of connected open edges
  std::size_t t_junctions = 0;     ///< vertices within an open edge: cracks without width
  std::size_t flipped_facets = 0;  ///< facets turned to agree with their neighbours
  std::size_t turned_shells = 0;   ///< whole shells that faced inward and were turned
  std::size_t overlapping_shells = 0;  ///< shells with facets within another shell
  std::size_t internal_facets = 0;     ///< facets with solid on both sides: not surface, left out
  std::size_t sheet_facets = 0;        ///< facets of free sheets: a surface without an inside
  std::size_t united_shells = 0;       ///< shells that touch or cross others and were replaced by their union
  bool signed_by_winding = false;      ///< false: signed by pseudonormals, which closed meshes allow
  /// Shells touch or cross each other, and their union was not found: depths near them are those of single
  /// shells, and their common volume counts twice in the mass.
  bool is_union_incomplete = false;
  /// Share of the voxmap's nodes in the band whose winding number is more than 0.25 from 0.5; 1 for a closed
  /// mesh.
  double certain_share = 1;
};

VPS_API Box bounds(const Mesh& mesh);
/// The box around each triangle.
VPS_API std::vector<Box> triangleBoxes(const Mesh& mesh);
VPS_API double area(const Mesh& mesh);

/// Mass properties by the divergence theorem; exact for a closed, outward-oriented mesh. O(triangles).
/// Source: Mirtich 1996 in the tetrahedron form of Eberly 2002.
VPS_API MassProperties massProperties(const Mesh& mesh);

/// The mesh with every vertex moved by X_AB (from B to A).
VPS_API Mesh transformed(const Mesh& mesh, const Pose& X_AB);

/// Appends b's triangles to a.
VPS_API void append(Mesh& a, const Mesh& b);

/// Merges vertices that are equal to within tolerance_m (0: to the bit) and drops triangles that collapse.
/// CAD exports repeat vertices for each face or triangle; only shared vertices tell which triangles connect.
VPS_API Mesh welded(const Mesh& mesh, double tolerance_m = 0);

struct WeldedMesh {
  Mesh mesh;                           ///< as returned by welded()
  std::vector<std::uint32_t> sources;  ///< for each triangle its number in the given mesh, ascending
};

/// As welded(), but also tells which triangle of the given mesh each triangle was.
VPS_API WeldedMesh weldedWithSources(const Mesh& mesh, double tolerance_m = 0);

/// Counts edges, shells, degenerate and duplicate triangles. O(n log n). Expects shared vertices (see
/// welded()).
VPS_API MeshReport checkMesh(const Mesh& mesh);

/// Returns the vertex pairs of edges whose two faces differ by more than angle_rad, and of all edges that do
/// not have exactly two triangles, in ascending order. Expects shared vertices (see welded()). O(n log n).
VPS_API std::vector<std::array<std::uint32_t, 2>> sharpEdges(const Mesh& mesh, double angle_rad);

/// Refuses meshes from which nothing can be built: no triangles, an index out of range, a coordinate that is
/// not finite, zero area. Throws LoadError naming file and part.
VPS_API void requireUsable(const Mesh& mesh, const std::string& file, const std::string& part);

/// Primitives for tests and simple scenes; all are centred at the origin, closed and face outward.
VPS_API Mesh makeBox(const Vec3& size_m);
/// Cylinder along z. Vertices lie on the true circle, so flats are inside it by r (1 - cos(pi / segments)).
VPS_API Mesh makeCylinder(double radius_m, double height_m, int segments);
/// Tube along z: outer and inner radius.
VPS_API Mesh makeTube(double outer_m, double inner_m, double height_m, int segments);
/// Sphere from a subdivided icosahedron: 20 * 4^level triangles, vertices on the sphere.
VPS_API Mesh makeSphere(double radius_m, int level);

}  // namespace vps
