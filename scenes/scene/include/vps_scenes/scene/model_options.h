// SPDX-License-Identifier: BSD-3-Clause
// Options, warnings and cost of building the models of a scene's parts.
#pragma once

#include <functional>
#include <string>

#include "vps/errors.h"
#include "vps/mesh.h"
#include "vps/voxmap_cache.h"
#include "vps_scenes/export.h"

namespace vps::scenes {

/// Number and memory of a scene's models.
struct ModelledCost {
  std::size_t voxmaps = 0, pointshells = 0;
  std::size_t points = 0;        ///< points of the parts' own pointshells
  std::size_t field_points = 0;  ///< points of the fixed field
  std::size_t bytes = 0;         ///< memory of all models
};

struct ModelOptions {
  Progress progress;
  bool models_everything = false;      ///< a complete map and shell for each part (model_plan.h)
  const VoxMapCache* cache = nullptr;  ///< keeps models between runs; null: each run builds the models
  double memory_bytes = 0;  ///< limit of the models' memory before the build; 0: the machine's memory
  /// Receives one line for each part whose mesh does not tell inside from outside everywhere. The function
  /// may be empty.
  std::function<void(const std::string&)> warn;
};

/// Defects of a mesh that make its inside uncertain, in words: "is not a closed surface: 2 open edges; inside
/// and outside are certain for 99.9 % of the space near the surface". The text is empty for a mesh without
/// such defects, for example a closed block with a void in the block.
VPS_SCENES_API std::string meshWarning(const MeshReport& report);

}  // namespace vps::scenes
