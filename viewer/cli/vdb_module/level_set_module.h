// SPDX-License-Identifier: BSD-3-Clause
// What the program asks of its module for .vdb files. Both throw LoadError.
#pragma once

#include <string>

#include "vps/voxmap.h"

namespace vps::viewer {

/// The module's one symbol, of C: an object of this type.
struct LevelSetModule {
  VoxMap (*load)(const std::string& file) = nullptr;
  void (*save)(const VoxMap& map, const std::string& file) = nullptr;
};
inline constexpr const char* kLevelSetSymbol = "vps_level_set_module";

}  // namespace vps::viewer
