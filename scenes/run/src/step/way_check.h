// SPDX-License-Identifier: BSD-3-Clause
// Whether a way is free of the parts in place, as drawn: why a hand could not follow it.
#pragma once

#include <string>

#include "judge/overlap_judge.h"
#include "world/assembly_world.h"

namespace vps::scenes {

/// "; the way that it was given leads through 'wall', up to 3.20 mm deep at ...", or nothing if all poses
/// that were tried are free. 24 exact measurements of overlap for each leg of the way.
std::string wallOnTheWay(AssemblyWorld& world, const SceneStep& step);

/// Whether a body is nowhere on a straight motion deeper in others than so much, but for its end.
/// @param center_P  moves on a straight line, while the body turns evenly
bool isFreeBetween(const OverlapJudge& judge, const JudgedBody& body, const Vec3& center_P, const Pose& from,
                   const Pose& to, double limit_m);

/// Whether a straight motion takes the part in hand from a pose to its target, and it is nowhere deeper in
/// others than at one of its ends or `limit_m`. As many measurements as for one leg.
bool isFreeToTarget(AssemblyWorld& world, const SceneStep& step, const Pose& X_WP, double limit_m);

/// Whether the part could go on beyond its target along the unit vector, as drawn, by so much and to the same
/// limit: then nothing but sight tells the hand where to stop.
bool isFreeBeyondTarget(AssemblyWorld& world, const SceneStep& step, const Vec3& axis_W, double by_m,
                        double limit_m);

}  // namespace vps::scenes
