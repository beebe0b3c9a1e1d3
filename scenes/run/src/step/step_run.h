// SPDX-License-Identifier: BSD-3-Clause
// One step of the procedure: the hand brings a part to its target and releases the part, and the part is
// judged.
#pragma once

#include <vector>

#include "judge/overlap_record.h"
#include "vps_scenes/run/result.h"
#include "world/assembly_world.h"
#include "world/run_trace.h"

namespace vps::scenes {

/// Runs scene.steps[index]. Throws LoadError as AssemblyWorld::take(). A step that fails is a result.
/// @param known  results of the step that are known in advance: checkDrawnTargets() and stands_on
StepResult runStep(AssemblyWorld& world, RunTrace& trace, std::size_t index, StepResult known);

// --- completion.cpp: whether the part reached its target, and if not, the reason

/// Pose of the part when the hand reported that the part is in place, or gave up. A part that nothing holds
/// falls from this pose while the hand opens.
struct Brought {
  Pose X_WP;
  bool is_given_up = false;
  bool is_faulted = false;  ///< the device had failed, so that no hand held the part
};

/// The greatest penetration that a step may have: min(10 um, clearance / 4).
double penetrationLimit_m(const SceneStep& step);

/// Sets final_error_m, final_error_rad, completed, by_contact and failure_reason. The step is completed if
/// the hand reports the end of its work, the device has not failed, and the part, now at rest, is within the
/// step's tolerances. May widen tolerance_m of a part that nothing stops along its way.
/// @param X_WP  pose of the part after its rest, or where the hand gave up
void judgeCompletion(AssemblyWorld& world, const SceneStep& step, const Pose& X_WP, const Brought& brought,
                     StepResult& result);

// --- settling.cpp: the judge measures the released part, and the field of the next step is cooked

/// Judges the step's samples and cooks the field of the next step, on other threads, then fixes the part: at
/// its present pose if the step was completed, else at its target, so that the next step finds it in place.
/// In lockstep, simulated time does not advance during this work, so the swap of the fields happens at the
/// same physics step in each run. In real time, loop and physics continue until both results are ready.
void settleStep(AssemblyWorld& world, std::vector<OverlapSample> samples, StepResult& result);

}  // namespace vps::scenes
