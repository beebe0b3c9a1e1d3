// SPDX-License-Identifier: BSD-3-Clause
// One step of a procedure: take the part, bring it to its target, release it, watch it at rest, judge it.
#pragma once

#include "vps_scenes/run/result.h"
#include "world/assembly_world.h"
#include "world/run_trace.h"

namespace vps::scenes {

/// Runs scene.steps[index]. Throws LoadError as AssemblyWorld::take(). A step that fails is a result.
/// @param known  what is known of it beforehand: block, stands_on
StepResult runStep(AssemblyWorld& world, RunTrace& trace, std::size_t index, StepResult known);

}  // namespace vps::scenes
