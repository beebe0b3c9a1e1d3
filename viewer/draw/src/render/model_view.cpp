// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/draw/model_view.h"

#include <algorithm>

#include "vps/solid.h"

namespace vps::viewer {

ShownModels shownModels(const std::vector<std::string>& words) {
  const auto has = [&](const char* word) { return std::ranges::find(words, word) != words.end(); };
  return {has("points"), has("voxels")};
}

ModelView::ModelView(const scenes::Scene& scene, const ShownModels& shown, RenderScene& drawn) {
  if (shown.isNone()) return;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const scenes::ScenePart& part = scene.parts[i];
    const bool is_moved =
        std::ranges::any_of(scene.steps, [i](const scenes::SceneStep& step) { return step.part == i; });
    const bool has_points = shown.has_points && (!shown.has_voxels || is_moved);
    const Solid solid(part.part.mesh, part.part.name);
    meshes_.push_back(std::make_unique<TintedMesh>());
    TintedMesh& model = *meshes_.back();
    const double voxel_m = part.voxel_m > 0 ? part.voxel_m : scene.fidelity.voxel_m;
    const double spacing_m = part.spacing_m > 0 ? part.spacing_m : scene.fidelity.spacing_m;
    if (has_points)
      model.mesh = pointMesh(buildPointShell(solid, {.spacing_m = spacing_m}, part.part.name));
    else
      model = voxelMesh(buildVoxMap(solid, {.voxel_m = voxel_m}, part.part.name));
    drawn[i].mesh = &model.mesh;
    if (!model.tints.empty()) drawn[i].vertex_colors = &model.tints;
  }
}

}  // namespace vps::viewer
