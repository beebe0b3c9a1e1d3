// SPDX-License-Identifier: BSD-3-Clause
// Models that the rows of a trade study share.
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "vps_scenes/scene/model_options.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Stores the maps of one scene's parts by voxel size, and their shells by spacing.
class ModelStore {
 public:
  /// Sets the models of the scene's parts; builds those that are not stored. Returns the build time [s].
  /// Throws as buildModels().
  double fill(Scene& scene, const ModelOptions& options);

 private:
  using Key = std::pair<std::size_t, double>;
  std::vector<std::shared_ptr<const PartModel>> models_;  ///< models of the last row, by part
  std::map<Key, std::shared_ptr<const VoxMap>> maps_;
  std::map<Key, std::shared_ptr<const PointShell>> shells_;
};

}  // namespace vps::scenes
