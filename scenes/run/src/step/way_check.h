// SPDX-License-Identifier: BSD-3-Clause
// Whether a path is free of the parts in place, as drawn, which explains why a hand could not follow it.
#pragma once

#include <string>

#include "judge/overlap_judge.h"
#include "world/assembly_world.h"

namespace vps::scenes {

/// "; the part's path leads through 'wall', up to 3.20 mm deep at ...", or empty if all tested
/// poses are free. Makes 24 exact measurements of overlap for each leg of the path.
std::string wallOnTheWay(AssemblyWorld& world, const SceneStep& step);

/// Whether a body on a straight motion, without its end pose, is nowhere deeper in other bodies than limit_m.
/// @param center_P  point that moves on a straight line, while the body turns at a constant rate
bool isFreeBetween(const OverlapJudge& judge, const JudgedBody& body, const Vec3& center_P, const Pose& from,
                   const Pose& to, double limit_m);

/// Whether the straight motion of the part in hand from X_WP to its target is free: nowhere deeper in other
/// bodies than limit_m or than at one of its ends. Makes as many measurements as wallOnTheWay() for one leg.
bool isFreeToTarget(AssemblyWorld& world, const SceneStep& step, const Pose& X_WP, double limit_m);

/// Whether the part, as drawn, could move beyond its target by by_m along the unit vector axis_W within
/// limit_m: if the part could, only sight tells the hand where to stop.
bool isFreeBeyondTarget(AssemblyWorld& world, const SceneStep& step, const Vec3& axis_W, double by_m,
                        double limit_m);

}  // namespace vps::scenes
