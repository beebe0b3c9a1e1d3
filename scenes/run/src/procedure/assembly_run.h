// SPDX-License-Identifier: BSD-3-Clause
// One run of a scene's procedure, for any hand and any log.
#pragma once

#include "haptics/hand.h"
#include "vps_device/run_log.h"
#include "vps_scenes/run/assemble_options.h"
#include "vps_scenes/scene/scene.h"
#include "world/loop_settings.h"

namespace vps::scenes {

/// Throws LoadError for a scene without a step, or with a part that is neither fixed, nor moved, nor scenery.
void requireSteps(const Scene& scene);

/// The hand of the scene, or of options.device. Throws LoadError as makeHand(scene, is_real_time).
std::unique_ptr<Hand> makeHand(const Scene& scene, const AssembleOptions& options);

/// Builds the models that the scene lacks and runs every step. A hand that cannot continue (the end of a
/// recording) ends the run. Throws as assemble().
/// @param log  may be null; receives the device's samples and wrenches, the operator's phases, and a trace at
///             the scene's csv_rate_hz
AssembleResult runProcedure(Scene& scene, Hand& hand, device::RunLog* log,
                            const device::LoopSettings& settings, const AssembleOptions& options);
/// Runs the procedure with the given result of checkDrawnTargets().
AssembleResult runProcedure(Scene& scene, Hand& hand, device::RunLog* log,
                            const device::LoopSettings& settings, const AssembleOptions& options,
                            const std::vector<StepResult>& drawn);

}  // namespace vps::scenes
