// SPDX-License-Identifier: BSD-3-Clause
// Settings of the haptic loop for a scene and a device.
#pragma once

#include "vps_device/device.h"
#include "vps_device/loop.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Settings with the gains of deriveGains(), except for gains that the scene states. Safety limits are the
/// device's peaks.
/// @param delay_s  delay that a network adds, from a state of the proxy to the answer, without the physics
/// step
device::LoopSettings loopSettings(const Scene& scene, const device::Device& device, double delay_s = 0);

/// The gains at which a device is passive in a scene, at physics rate physics_rate_hz.
CouplingGains passiveGains(const Scene& scene, const device::DeviceLimits& limits, double physics_rate_hz,
                           double delay_s = 0);

/// Haptic ticks in one physics step. Throws LoadError if the haptic rate is not a whole multiple of the
/// physics rate.
int ticksPerStep(const Scene& scene);

}  // namespace vps::scenes
