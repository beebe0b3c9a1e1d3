// SPDX-License-Identifier: BSD-3-Clause
// Finds the pose of the right arm's base relative to the left one's from readings of the rigid handle.
#pragma once

#include <cstddef>
#include <span>

#include "vps_device/dual_arm/kinematics.h"
#include "vps_device/export.h"

namespace vps::device {

struct BaseCalibration {
  /// Ok; Truncated: fewer than twelve readings; BadPose: a reading is not finite; Singular: the readings are
  /// too similar to determine all six numbers, more positions and tilts are needed; Fault: no convergence,
  /// the start is too far off.
  Status status = Status::Fault;
  DualArmParameters parameters;       ///< the given ones with the right base corrected; unchanged unless Ok
  double rms_m = 0;                   ///< residual | |P_R - P_L| - L |
  double sigma_m = 0, sigma_rad = 0;  ///< standard deviation of the result, greatest direction
  int iterations = 0;
};

/// The gimbal centres are L apart at every pose of the handle: six unknowns (shift and rotation of the right
/// base), one equation per reading, least squares by Gauss-Newton from `parameters`. L is assumed to be
/// known. Allocates nothing; O(readings) each of a few iterations.
VPS_DEVICE_API BaseCalibration calibrateBases(const DualArmParameters& parameters,
                                              std::span<const DualArmJoints> readings) noexcept;

}  // namespace vps::device
