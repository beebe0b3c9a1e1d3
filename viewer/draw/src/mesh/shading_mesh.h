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

/// An edge inside a smooth surface. The edge is part of the outline if one of its faces is seen from the
/// front and the other from behind.
struct SmoothEdge {
  ShadingEdge edge;
  std::array<float, 3> n_left, n_right;
};

struct ShadingMesh {
  Vec3 center = Vec3::Zero();  ///< in the part's frame; separate, so that floats stay precise in parts far
                               ///< from their origin
  std::vector<ShadingVertex> vertices;
  std::vector<std::uint32_t> sources;        ///< by shading vertex: index of the mesh's vertex
  std::vector<std::array<float, 3>> colors;  ///< linear RGB by shading vertex; empty: none is given
  std::vector<std::uint32_t> indices;
  /// Edges whose dihedral angle exceeds the crease angle, and open borders
  std::vector<ShadingEdge> sharp_edges;
  std::vector<SmoothEdge> smooth_edges;
  /// Whether each edge lies between two triangles with consistent orientation. From outside, only front faces
  /// of a closed mesh are visible.
  bool is_closed = false;
};

/// The crease angle is 28 degrees: less than a chamfer of 30 degrees, and more than the angle between the
/// facets of tessellated cylinders (up to 20).
inline constexpr double kCreaseAngle_rad = 28 * 3.14159265358979323846 / 180;

/// Builds the mesh for drawing; O(n log n) in the triangles.
/// @param crease_rad faces that meet at a smaller angle are shaded as one smooth surface
/// @param colors     colours by triangle of the mesh; null, or a list of another length: no colours
ShadingMesh buildShadingMesh(const Mesh& mesh, double crease_rad = kCreaseAngle_rad,
                             const scenes::FaceColors* colors = nullptr);

/// The intersection of the mesh with the plane n.p = offset (in the part's frame): unordered segments,
/// relative to center.
std::vector<ShadingEdge> sectionSegments(const ShadingMesh& mesh, const Vec3& n, double offset);

}  // namespace vps::viewer
