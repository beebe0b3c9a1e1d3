// SPDX-License-Identifier: BSD-3-Clause
// A mesh as a picture needs it: smooth where it is meant smooth, with its sharp edges and what can become
// outline.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vps/mesh.h"

namespace vps::viewer {

struct ShadingVertex {
  std::array<float, 3> p;  ///< relative to ShadingMesh::center
  std::array<float, 3> n;
};

/// An edge, in the same frame as the vertices.
struct ShadingEdge {
  std::array<float, 3> a, b;
};

/// An edge between two faces that a smooth surface continues across: outline where one face is seen from the
/// front and the other from behind.
struct SmoothEdge {
  ShadingEdge edge;
  std::array<float, 3> n_left, n_right;
};

struct ShadingMesh {
  Vec3 center = Vec3::Zero();  ///< in the part's frame; kept apart so that float vertices far out stay exact
  std::vector<ShadingVertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<ShadingEdge> sharp_edges;  ///< dihedral beyond the crease angle, and open borders
  std::vector<SmoothEdge> smooth_edges;
};

/// 28 degrees: below a 30 degree chamfer, above the facets that CAD tessellation leaves on cylinders (20 and
/// less).
inline constexpr double kCreaseAngle_rad = 28 * 3.14159265358979323846 / 180;

/// @param crease_rad faces that meet at a smaller angle are shaded as one smooth surface. O(n log n).
ShadingMesh buildShadingMesh(const Mesh& mesh, double crease_rad = kCreaseAngle_rad);

/// Where a plane n.p = offset (in the part's frame) cuts the mesh: unordered segments, relative to center.
std::vector<ShadingEdge> sectionSegments(const ShadingMesh& mesh, const Vec3& n, double offset);

}  // namespace vps::viewer
