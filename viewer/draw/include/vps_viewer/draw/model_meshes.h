// SPDX-License-Identifier: BSD-3-Clause
// Pointshells and voxels as meshes (figures 7 and 8 of the paper), and a scene drawn with them in place of
// its parts.
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

/// Such a mesh has at most this many triangles, so that single points and cubes are seen in a picture.
inline constexpr std::size_t kModelTriangles = 120000;

/// A flat square diamond on each point, across its normal; of a shell with too many points, the even coarser
/// sampling that its order begins with.
/// @param size_m  of a diamond's diagonal; 0: 0.6 of the spacing of what is drawn
VPS_VIEWER_API Mesh pointMesh(const PointShell& shell, double size_m = 0);

/// A mesh with a tint for each vertex, as DrawnMesh::vertex_colors takes it.
struct TintedMesh {
  Mesh mesh;
  std::vector<std::array<float, 3>> tints;
};

/// Cubes of the grid whose middle is inside: their faces to the outside, by turns lighter and darker. A map
/// with too many of them is drawn with cubes of twice, thrice, ... the voxel's size.
/// @param cube_m  if given, receives their edge
VPS_VIEWER_API TintedMesh voxelMesh(const VoxMap& map, double* cube_m = nullptr);

struct ShownModels {
  bool has_points = false, has_voxels = false;
  [[nodiscard]] bool isNone() const { return !has_points && !has_voxels; }
};
/// From the words of `--show`: "points", "voxels".
VPS_VIEWER_API ShownModels shownModels(const std::vector<std::string>& words);

/// Pointshells and voxels in place of the parts (figures 7 and 8 of the paper): where both are shown, points
/// of the parts that a step moves and voxels of the others, as contact uses them.
class VPS_VIEWER_API ModelView {
 public:
  /// Changes the meshes of `drawn`, to its own, which live as long as it does.
  ModelView(const scenes::Scene& scene, const ShownModels& shown, RenderScene& drawn);

 private:
  std::vector<std::unique_ptr<TintedMesh>> meshes_;
};

}  // namespace vps::viewer
