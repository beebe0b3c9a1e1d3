// SPDX-License-Identifier: BSD-3-Clause
#include "trade/model_store.h"

#include "core/machine.h"
#include "models/scene_models.h"

namespace vps::scenes {

double ModelStore::fill(Scene& scene, const ModelOptions& options) {
  const double voxel_m = scene.fidelity.voxel_m, spacing_m = scene.fidelity.spacing_m;
  models_.resize(scene.parts.size());
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    PartModel model = models_[i] ? *models_[i] : PartModel{};  // mesh and surface are the same for every row
    model.map = maps_[{i, voxel_m}];
    model.shell = shells_[{i, spacing_m}];
    scene.parts[i].is_cropped = false;
    scene.parts[i].model = std::make_shared<const PartModel>(std::move(model));
  }
  const double begun_s = wallSeconds();
  buildModels(scene, options);
  const double wall_s = wallSeconds() - begun_s;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    models_[i] = scene.parts[i].model;
    maps_[{i, voxel_m}] = models_[i]->map;
    shells_[{i, spacing_m}] = models_[i]->shell;
  }
  return wall_s;
}

}  // namespace vps::scenes
