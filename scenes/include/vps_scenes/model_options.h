// SPDX-License-Identifier: BSD-3-Clause
// How the models of a scene's parts come about.
#pragma once

#include <functional>
#include <string>

#include "vps/progress.h"
#include "vps/voxmap_cache.h"

namespace vps::scenes {

struct ModelOptions {
  Progress progress;
  bool models_everything = false;      ///< no sparing: plan.h
  const VoxMapCache* cache = nullptr;  ///< where voxmaps are kept; null: built each time
  /// Told, in one line, of each part whose inside and outside could not be told for sure.
  std::function<void(const std::string&)> warn;
};

}  // namespace vps::scenes
