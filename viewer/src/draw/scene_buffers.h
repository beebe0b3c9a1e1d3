// SPDX-License-Identifier: BSD-3-Clause
// The meshes of a scene in graphics memory, and the bodies of one picture.
#pragma once

#include <memory>
#include <vector>

#include "draw/gl_objects.h"
#include "draw/shading_mesh.h"
#include "vps_viewer/renderer.h"

namespace vps::viewer::inline v0 {

/// Line segments in graphics memory.
struct GpuLines {
  gl::Buffer buffer;
  gl::VertexArray array;
  GLsizei count = 0;
  explicit GpuLines(std::span<const ShadingEdge> segments);
};

struct GpuMesh {
  Box bounds_P;         ///< in the part's frame
  ShadingMesh shading;  ///< kept, because outlines and sections are computed on the CPU for each picture
  gl::Buffer vertices, colors, indices, coarse_indices;
  gl::VertexArray array, coarse_array;
  GpuLines sharp_edges;
  GLsizei index_count = 0, coarse_count = 0;
  /// @param coarse_share  share of the triangles that a draft draws, 1: all
  GpuMesh(const Mesh& mesh, const std::vector<std::array<float, 3>>* vertex_colors, double coarse_share);
  void draw(bool is_coarse) const;
};

/// A part at its pose in one picture.
struct DrawnBody {
  const GpuMesh* mesh = nullptr;
  std::size_t part = 0;
  Pose X_CP;  ///< mesh centre in the camera frame
  Eigen::Vector3f color = Eigen::Vector3f::Zero();
  bool is_cut = false;
  bool is_coarse = false;
};

Eigen::Matrix4f toMatrix(const Pose& X);

/// The edges at which a smooth surface turns away from the eye.
std::vector<ShadingEdge> outline(const ShadingMesh& mesh, const Vec3& p_eye);

}  // namespace vps::viewer::inline v0
