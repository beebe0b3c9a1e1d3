// SPDX-License-Identifier: BSD-3-Clause
// Models that a trade's rows share.
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "vps_scenes/model_options.h"
#include "vps_scenes/scene.h"

namespace vps::scenes {

/// A part's map by voxel size, its shell by spacing. Of one scene: parts go by their index.
class ModelStore {
 public:
  /// Gives the scene's parts their models. Returns the seconds that building took. Throws as buildModels().
  double fill(Scene& scene, const ModelOptions& options);

 private:
  using Key = std::pair<std::size_t, double>;
  std::vector<std::shared_ptr<const PartModel>> models_;  ///< of the last row, by part
  std::map<Key, std::shared_ptr<const VoxMap>> maps_;
  std::map<Key, std::shared_ptr<const PointShell>> shells_;
};

}  // namespace vps::scenes
