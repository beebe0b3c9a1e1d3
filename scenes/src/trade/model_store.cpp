// SPDX-License-Identifier: BSD-3-Clause
#include "trade/model_store.h"

#include "core/wall_clock.h"
#include "models/scene_models.h"

namespace vps::scenes {

double ModelStore::fill(Scene& scene, const ModelOptions& options) {
  const double voxel_m = scene.fidelity.voxel_m, spacing_m = scene.fidelity.spacing_m;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    scene.parts[i].is_cropped = false;
    scene.parts[i].part.map = maps_[{i, voxel_m}];
    scene.parts[i].part.shell = shells_[{i, spacing_m}];
  }
  const double begun_s = wallSeconds();
  buildModels(scene, options);
  const double wall_s = wallSeconds() - begun_s;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    maps_[{i, voxel_m}] = scene.parts[i].part.map;
    shells_[{i, spacing_m}] = scene.parts[i].part.shell;
  }
  return wall_s;
}

}  // namespace vps::scenes
