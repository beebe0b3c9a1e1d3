// SPDX-License-Identifier: BSD-3-Clause
// The one place where verdicts are made: whether a step reached its target, whether its part fits, and if
// not, why.
#pragma once

#include "vps_scenes/run/result.h"
#include "world/assembly_world.h"

namespace vps::scenes {

/// The greatest penetration that a step may have: min(10 um, clearance / 4).
double penetrationLimit_m(const SceneStep& step);

/// Sets final_error_m, final_error_rad, completed and failure_reason: the step is completed when the hand
/// reports that it is done and the part, now at rest, is within the step's tolerances.
/// @param X_WP          of the part, after its rest, or where the hand gave up
/// @param X_WP_brought  where the hand took it to be in place, or gave up
void judgeCompletion(AssemblyWorld& world, const SceneStep& step, const Pose& X_WP, const Pose& X_WP_brought,
                     StepResult& result);

/// Sets verdict and reason from the rest of a step's result.
/// @param hand_N  greatest force of the hand
void judgeStep(StepResult& result, double hand_N);

}  // namespace vps::scenes
