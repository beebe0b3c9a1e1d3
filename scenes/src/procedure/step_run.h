// SPDX-License-Identifier: BSD-3-Clause
// One step of a procedure: take the part, bring it to its target, release it, watch it at rest, judge it.
#pragma once

#include "procedure/assembly_world.h"
#include "procedure/run_trace.h"
#include "vps_scenes/result.h"

namespace vps::scenes::inline v0 {

/// Runs scene.steps[index]. Throws LoadError as AssemblyWorld::take(). A step that fails is a result.
StepResult runStep(AssemblyWorld& world, RunTrace& trace, std::size_t index);

}  // namespace vps::scenes::inline v0
