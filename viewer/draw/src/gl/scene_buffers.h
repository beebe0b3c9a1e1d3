// SPDX-License-Identifier: BSD-3-Clause
// The meshes of a scene in graphics memory, and the bodies of one picture.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "gl/gl_objects.h"
#include "mesh/coarse_mesh.h"
#include "mesh/shading_mesh.h"
#include "vps_viewer/draw/render_scene.h"

namespace vps::viewer {

/// Line segments in graphics memory.
struct GpuLines {
  gl::Buffer buffer;
  gl::VertexArray array;
  GLsizei count = 0;
  explicit GpuLines(std::span<const ShadingEdge> segments);
};

/// How many of a mesh's triangles are drawn.
enum class Detail {
  Full,
  Shadow,  ///< at most about kShadowTriangles in the whole scene
  Draft,   ///< at most about kDraftTriangles in the whole scene
};
/// The blur of shadows is wider than the error of a scene with this many triangles.
inline constexpr std::size_t kShadowTriangles = 120000;

struct GpuMesh {
  Box bounds_P;         ///< in the part's frame
  ShadingMesh shading;  ///< kept, because outlines and sections are computed on the CPU for each picture
  bool has_face_colors = false;
  gl::Buffer vertices, colors;
  GpuLines sharp_edges;
  /// @param scene_triangles  number of triangles of all meshes, on which the levels of detail depend
  GpuMesh(const DrawnMesh& part, std::size_t scene_triangles);
  void draw(Detail detail) const;
  /// Draws the coarsest level whose error is invisible at the given scale.
  /// @param px_per_m  pixels per metre at the nearest point of the part
  void drawAt(double px_per_m) const;
  /// Whether the mesh has fewer triangles at the given detail than in full.
  [[nodiscard]] bool isCoarser(Detail detail) const { return of(detail).count < of(Detail::Full).count; }

 private:
  struct Indices {
    gl::Buffer buffer;
    gl::VertexArray array;
    GLsizei count = 0;
  };
  void addLevels(CoarseMesh& coarse);
  [[nodiscard]] Indices indicesOf(const std::vector<std::uint32_t>& indices) const;
  [[nodiscard]] const Indices& of(Detail detail) const { return details_[static_cast<std::size_t>(detail)]; }

  struct Level {
    double cell_m = 0;
    Indices indices;
  };
  std::array<Indices, 3> details_;  ///< by Detail
  std::vector<Level> levels_;       ///< levels of smoothed meshes, the coarsest first
};

/// A part at its pose in one picture.
struct DrawnBody {
  const GpuMesh* mesh = nullptr;
  std::size_t part = 0;
  Pose X_CP;  ///< mesh centre in the camera frame
  Eigen::Vector3f color = Eigen::Vector3f::Zero();
  bool shows_faces = false;  ///< the part's faces have their own colours in place of `color`
  bool is_cut = false;
  Detail detail = Detail::Full;
};

Eigen::Matrix4f toMatrix(const Pose& X);

/// The edges at which a smooth surface turns away from the eye.
std::vector<ShadingEdge> outline(const ShadingMesh& mesh, const Vec3& p_eye);

}  // namespace vps::viewer
