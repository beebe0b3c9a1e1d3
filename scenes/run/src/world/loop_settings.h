// SPDX-License-Identifier: BSD-3-Clause
// The settings of the haptic loop that follow from a scene and a device.
#pragma once

#include "vps_device/device.h"
#include "vps_device/loop.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Gains from deriveGains(), except those that the scene states. Safety limits are the device's peaks.
/// @param delay_s  from a state of the proxy to the answer to it, beyond the physics step: of a network
device::LoopSettings loopSettings(const Scene& scene, const device::Device& device, double delay_s = 0);

/// The gains at which a device is passive in a scene, at this physics rate.
CouplingGains passiveGains(const Scene& scene, const device::DeviceLimits& limits, double physics_rate_hz,
                           double delay_s = 0);

/// Haptic ticks in one physics step. Throws LoadError if the haptic rate is not a whole multiple of the
/// physics rate.
int ticksPerStep(const Scene& scene);

}  // namespace vps::scenes
