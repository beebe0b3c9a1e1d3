// SPDX-License-Identifier: BSD-3-Clause
// Refuses meshes whose map would not fit in memory, before any memory is allocated.
#pragma once

#include <string>

#include "vps/voxmap.h"

namespace vps {

/// Throws LoadError for settings that no map can have and for a mesh whose map would not fit in memory; the
/// message names a voxel size that would fit.
void requireFits(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part);

}  // namespace vps
