// SPDX-License-Identifier: BSD-3-Clause
// The end of a step: the judge measures the part that was released, the next step's field is cooked, and both
// are put in place.
#pragma once

#include <vector>

#include "judge/overlap_record.h"
#include "vps_scenes/run/result.h"
#include "world/assembly_world.h"

namespace vps::scenes {

/// Judges the step's samples and cooks the field of the next step, on other threads, then fixes the part:
/// where it lies if the step was completed, else at its target, so that the next step has what it is mounted
/// on. In lockstep, simulated time stands still meanwhile, so the swap happens at the same physics step in
/// each run. By the clock, loop and physics go on until both are ready.
void settleStep(AssemblyWorld& world, std::vector<OverlapSample> samples, StepResult& result);

}  // namespace vps::scenes
