// SPDX-License-Identifier: BSD-3-Clause
// Options for building the models of a scene's parts.
#pragma once

#include <functional>
#include <string>

#include "vps/progress.h"
#include "vps/voxmap_cache.h"

namespace vps::scenes {

struct ModelOptions {
  Progress progress;
  bool models_everything = false;      ///< models every part everywhere (model_plan.h)
  const VoxMapCache* cache = nullptr;  ///< where models are kept between runs; null: built each time
  double memory_bytes =
      0;  ///< models that need more are refused before any is built; 0: what the machine has
  /// Gets one line for each part whose inside and outside could not be told apart with certainty. May be
  /// empty.
  std::function<void(const std::string&)> warn;
};

}  // namespace vps::scenes
