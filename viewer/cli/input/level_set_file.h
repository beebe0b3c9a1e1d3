// SPDX-License-Identifier: BSD-3-Clause
// Voxmaps as .vdb files, in builds with and without OpenVDB.
#pragma once

#include <string>

#include "vps/voxmap.h"

namespace vps::viewer {

/// Throws LoadError that names the file in a build without OpenVDB, and where the program's module for it
/// cannot be loaded.
void requireOpenVdb(const std::string& file);

/// These throw LoadError when the file cannot be used, and in a build without OpenVDB.
VoxMap loadLevelSet(const std::string& file);
void saveLevelSet(const VoxMap& map, const std::string& file);

}  // namespace vps::viewer
