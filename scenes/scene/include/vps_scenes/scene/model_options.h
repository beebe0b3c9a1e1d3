// SPDX-License-Identifier: BSD-3-Clause
// Options for building the models of a scene's parts.
#pragma once

#include <functional>
#include <string>

#include "vps/errors.h"
#include "vps/voxmap_cache.h"

namespace vps::scenes {

/// What the models of a scene take.
struct ModelledCost {
  std::size_t voxmaps = 0, pointshells = 0;
  std::size_t points = 0;        ///< of the parts' own pointshells
  std::size_t field_points = 0;  ///< of the fixed field
  std::size_t bytes = 0;         ///< of all
};

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
