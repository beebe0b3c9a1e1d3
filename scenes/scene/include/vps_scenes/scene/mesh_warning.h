// SPDX-License-Identifier: BSD-3-Clause
// Why a mesh gives reason to doubt what is inside of it, in words.
#pragma once

#include <string>

#include "vps/mesh.h"
#include "vps_scenes/export.h"

namespace vps::scenes {

/// "is not a closed surface: 2 open edges; inside and outside are certain for 99.9 % of the space near it",
/// or what else is amiss; empty where nothing is, as for a closed block with a void in it.
VPS_SCENES_API std::string meshWarning(const MeshReport& report);

}  // namespace vps::scenes
