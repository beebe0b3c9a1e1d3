// SPDX-License-Identifier: BSD-3-Clause
// Whether a way is free of the parts in place, as drawn: why a hand could not follow it.
#pragma once

#include <string>

#include "procedure/assembly_world.h"

namespace vps::scenes::inline v0 {

/// "; the way that it was given leads through 'wall', up to 3.20 mm deep at ...", or nothing if all poses
/// that were tried are free. 24 exact measurements of overlap for each leg of the way.
std::string wallOnTheWay(AssemblyWorld& world, const SceneStep& step);

/// Whether a straight motion takes the part in hand from a pose to its target, and it is nowhere deeper in
/// others than at one of its ends or `limit_m`. As many measurements as for one leg.
bool isFreeToTarget(AssemblyWorld& world, const SceneStep& step, const Pose& X_WP, double limit_m);

}  // namespace vps::scenes::inline v0
