// SPDX-License-Identifier: BSD-3-Clause
// Where the right arm's base stands against the left one's, found from readings of the rigid handle.
#pragma once

#include <cstddef>
#include <span>

#include "vps_device/dual_arm.h"
#include "vps_device/export.h"

namespace vps::device {

struct BaseCalibration {
  /// Ok; Truncated: fewer than twelve readings; BadPose: a reading is not finite; Singular: the readings are
  /// too alike to tell all six numbers, turn the handle and move it about more; Fault: it did not settle, the
  /// start is too far off.
  Status status = Status::Fault;
  DualArmParameters parameters;       ///< the given ones, with the right base put right; as given unless Ok
  double rms_m = 0;                   ///< of what is left of | |P_R - P_L| - L |
  double sigma_m = 0, sigma_rad = 0;  ///< standard deviation of the result, greatest direction
  int iterations = 0;
};

/// The handle keeps the gimbal centres L apart, wherever it is: six unknowns (shift and turn of the right
/// base), one equation a reading, least squares by Gauss and Newton from `parameters`. L is taken as known.
/// Allocates nothing; O(readings) each of a few iterations.
VPS_DEVICE_API BaseCalibration calibrateBases(const DualArmParameters& parameters,
                                              std::span<const DualArmJoints> readings) noexcept;

}  // namespace vps::device
