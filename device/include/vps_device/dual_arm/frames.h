// SPDX-License-Identifier: BSD-3-Clause
// The paper's three coordinate systems: one local to each arm, and one independent of both.
#pragma once

#include "vps_device/dual_arm/kinematics.h"

namespace vps::device {

enum class DeviceFrame {
  Independent,  ///< D: origin at the workspace's centre
  Left,         ///< left arm's base: x towards the other arm, z up
  Right,        ///< right arm's base
};
const char* toText(DeviceFrame frame) noexcept;

/// Pose of a frame in D; the right arm's as calibrated.
Pose framePose(const DualArmParameters& parameters, DeviceFrame frame) noexcept;

/// Expresses a pose, velocity or wrench given in `from` in `to`. Velocity and wrench keep their reference
/// point.
Pose inFrame(const DualArmParameters& parameters, const Pose& X, DeviceFrame from, DeviceFrame to) noexcept;
Twist inFrame(const DualArmParameters& parameters, const Twist& V, DeviceFrame from, DeviceFrame to) noexcept;
Wrench inFrame(const DualArmParameters& parameters, const Wrench& F, DeviceFrame from,
               DeviceFrame to) noexcept;

}  // namespace vps::device
