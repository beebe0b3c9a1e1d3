// SPDX-License-Identifier: BSD-3-Clause
// The paper's three coordinate systems: one local to each arm, and one independent of both.
#pragma once

#include "vps_device/dual_arm/kinematics.h"
#include "vps_device/export.h"

namespace vps::device {

enum class DeviceFrame {
  Independent,  ///< D: origin at the workspace's centre
  Left,         ///< left arm's base: x towards the other arm, z up
  Right,        ///< right arm's base
};
VPS_DEVICE_API const char* toText(DeviceFrame frame) noexcept;

/// Pose of a frame in D; the right arm's as calibrated.
VPS_DEVICE_API Pose framePose(const DualArmParameters& parameters, DeviceFrame frame) noexcept;

/// Expresses a pose, velocity or wrench given in `from` in `to`. Velocity and wrench keep their reference
/// point.
VPS_DEVICE_API Pose inFrame(const DualArmParameters& parameters, const Pose& X, DeviceFrame from,
                            DeviceFrame to) noexcept;
VPS_DEVICE_API Twist inFrame(const DualArmParameters& parameters, const Twist& V, DeviceFrame from,
                             DeviceFrame to) noexcept;
VPS_DEVICE_API Wrench inFrame(const DualArmParameters& parameters, const Wrench& F, DeviceFrame from,
                              DeviceFrame to) noexcept;

}  // namespace vps::device
