// SPDX-License-Identifier: BSD-3-Clause
// A mesh for drawing: shading normals, sharp edges, and edges that can be part of an outline.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vps/mesh.h"
#include "vps/pose.h"
#include "vps_scenes/cad/colors.h"

namespace vps::viewer {

inline std::array<float, 3> toFloat(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

inline Vec3 toVec3(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

struct ShadingVertex {
  std::array<float, 3> p;  ///< relative to ShadingMesh::center
  std::array<float, 3> n;
};

/// An edge, in the same frame as the vertices.
struct ShadingEdge {
  std::array<float, 3> a, b;
};

/// An edge inside a smooth surface. It is part of the outline when one of its faces is seen from the front
/// and the other from behind.
struct SmoothEdge {
  ShadingEdge edge;
  std::array<float, 3> n_left, n_right;
};

struct ShadingMesh {
  Vec3 center = Vec3::Zero();  ///< in the part's frame; separate, so that floats keep their precision far out
  std::vector<ShadingVertex> vertices;
  std::vector<std::uint32_t> sources;        ///< by shading vertex: that of the mesh
  std::vector<std::array<float, 3>> colors;  ///< linear RGB by shading vertex; empty: none is given
  std::vector<std::uint32_t> indices;
  std::vector<ShadingEdge> sharp_edges;  ///< dihedral angle beyond the crease angle, and open borders
  std::vector<SmoothEdge> smooth_edges;
  /// Each edge is between two triangles that agree on what is outside: seen from there, only front faces
  /// show.
  bool is_closed = false;
};

/// 28 degrees: less than a chamfer of 30 degrees, more than between the facets of tessellated cylinders (up
/// to 20).
inline constexpr double kCreaseAngle_rad = 28 * 3.14159265358979323846 / 180;

/// O(n log n).
/// @param crease_rad faces that meet at a smaller angle are shaded as one smooth surface
/// @param colors     of the mesh's triangles; null, or of another number of them: none
ShadingMesh buildShadingMesh(const Mesh& mesh, double crease_rad = kCreaseAngle_rad,
                             const scenes::FaceColors* colors = nullptr);

/// The intersection of the mesh with the plane n.p = offset (in the part's frame): unordered segments,
/// relative to center.
std::vector<ShadingEdge> sectionSegments(const ShadingMesh& mesh, const Vec3& n, double offset);

}  // namespace vps::viewer
