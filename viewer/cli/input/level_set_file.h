// SPDX-License-Identifier: BSD-3-Clause
// Voxmaps as .vdb files. The functions call a module of the program (vdb_module/), which alone is linked with
// OpenVDB and is loaded when a .vdb file is read or written. A build without OpenVDB has no module.
#pragma once

#include <cstddef>
#include <string>

#include "vps/voxmap.h"

namespace vps::viewer {

/// Throws LoadError that names the file if the program was built without OpenVDB or cannot load its module.
void requireOpenVdb(const std::string& file);

/// Reads a voxmap. Throws LoadError if the file cannot be used, or as requireOpenVdb().
VoxMap loadLevelSet(const std::string& file);
/// Writes a voxmap. Throws LoadError if the file cannot be written, or as requireOpenVdb().
void saveLevelSet(const VoxMap& map, const std::string& file);

/// Functions that the module provides. Both functions throw LoadError. The first two members tell a module of
/// another build, whose voxmaps may have another layout.
struct LevelSetModule {
  const char* version = "";      ///< VPS_VERSION_STRING of the module's build
  std::size_t voxmap_bytes = 0;  ///< sizeof(VoxMap) in the module's build
  VoxMap (*load)(const std::string& file) = nullptr;
  void (*save)(const VoxMap& map, const std::string& file) = nullptr;
};
/// Name of the module's only exported symbol, which has C linkage: a LevelSetModule.
inline constexpr const char* kLevelSetSymbol = "vps_level_set_module";

}  // namespace vps::viewer
