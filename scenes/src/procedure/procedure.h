// SPDX-License-Identifier: BSD-3-Clause
// One run of a procedure, whoever moves the handle and whoever listens.
#pragma once

#include "haptics/hand.h"
#include "vps_device/loop.h"
#include "vps_device/run_log.h"
#include "vps_scenes/assemble.h"

namespace vps::scenes {

/// The loop's settings for a scene on a device: gains by deriveGains() where the scene does not wish
/// otherwise.
device::LoopSettings loopSettings(const Scene& scene, const device::Device& device);

/// Builds what the scene lacks and runs every step. `log` (may be null) is told all that the device reads and
/// is given, what the hand is about, and a trace at the scene's csv_rate_hz. A hand that cannot go on ends
/// the run. Throws as assemble().
AssembleResult runProcedure(Scene& scene, Hand& hand, device::RunLog* log,
                            const device::LoopSettings& settings, const AssembleOptions& options);

}  // namespace vps::scenes
