// SPDX-License-Identifier: BSD-3-Clause
// The models of contact drawn in place of the parts.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vps_scenes/scene/scene.h"
#include "vps_viewer/draw/model_meshes.h"
#include "vps_viewer/draw/render_scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

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
