// SPDX-License-Identifier: BSD-3-Clause
// Pointshells and voxels as meshes (figures 7 and 8 of Tripicchio et al.), and a scene drawn with them in
// place of its parts.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "vps/pointshell.h"
#include "vps/voxmap.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/draw/render_scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// Greatest number of triangles of pointMesh() and voxelMesh(); single points and cubes stay visible in a
/// picture.
inline constexpr std::size_t kModelTriangles = 120000;

/// A flat square diamond on each point, perpendicular to the point's normal. If the shell has too many
/// points, only the first points of its order are drawn, which sample the surface evenly, too.
/// @param size_m  diagonal of a diamond [m]; 0: 0.6 of the spacing of the drawn points
VPS_VIEWER_API Mesh pointMesh(const PointShell& shell, double size_m = 0);

/// A mesh with a tint for each vertex, for DrawnMesh::vertex_colors.
struct TintedMesh {
  Mesh mesh;
  std::vector<std::array<float, 3>> tints;
};

/// The outer faces of the grid's cubes whose middle is inside the map, alternately lighter and darker. If
/// there are too many faces, the cubes have twice, three times, ... the voxel's size.
/// @param cube_m  if given, receives the edge of a cube [m]
VPS_VIEWER_API TintedMesh voxelMesh(const VoxMap& map, double* cube_m = nullptr);

struct ShownModels {
  bool has_points = false, has_voxels = false;
  [[nodiscard]] bool isNone() const { return !has_points && !has_voxels; }
};
/// The models that `--show` names: "points", "voxels".
VPS_VIEWER_API ShownModels shownModels(const std::vector<std::string>& words);

/// Pointshells and voxels in place of the parts (figures 7 and 8 of Tripicchio et al.): where both are shown,
/// points of the parts that a step moves and voxels of the others, as contact uses them.
class VPS_VIEWER_API ModelView {
 public:
  /// Replaces the meshes of `drawn` by meshes that the ModelView owns; keep the ModelView as long as `drawn`
  /// is used.
  ModelView(const scenes::Scene& scene, const ShownModels& shown, RenderScene& drawn);

 private:
  std::vector<std::unique_ptr<TintedMesh>> meshes_;
};

}  // namespace vps::viewer
