// SPDX-License-Identifier: BSD-3-Clause
// Why a hand could not follow its way: as drawn, the way leads through a part in place.
#pragma once

#include <string>

#include "procedure/assembly_world.h"

namespace vps::scenes::inline v0 {

/// "; the way that it was given leads through 'wall', up to 3.20 mm deep at ...", or nothing if all poses
/// that were tried are free. 24 exact measurements of overlap for each leg of the way.
std::string wallOnTheWay(AssemblyWorld& world, const SceneStep& step);

}  // namespace vps::scenes::inline v0
