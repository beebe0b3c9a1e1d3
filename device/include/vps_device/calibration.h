// SPDX-License-Identifier: BSD-3-Clause
// Calibration: the pose of a device in a room, and the pose of the dual arm's right base.
#pragma once

#include <cstddef>
#include <span>

#include "vps_device/dual_arm/kinematics.h"
#include "vps_device/export.h"

namespace vps::device {

// --- Placement of a device in a room, from touched points whose positions in the room S are known

/// A point touched by the handle's origin.
struct TouchedPoint {
  Vec3 p_D = Vec3::Zero();  ///< position read by the device
  Vec3 p_S = Vec3::Zero();  ///< position in the room
};

struct Placement {
  /// Ok; Truncated: fewer than three points; BadPose: a point is not finite; Singular: the points lie on a
  /// line, about which the rotation is not determined.
  Status status = Status::Truncated;
  Pose X_SD;
  double rms_m = 0, greatest_m = 0;  ///< residuals | X_SD p_D - p_S |
  std::size_t worst = 0;             ///< index of the point with the greatest residual
};

/// The pose with the least sum of squared residuals. O(points). Source: Kabsch 1976; Umeyama 1991, for its
/// sign of reflections.
VPS_DEVICE_API Placement fitPlacement(std::span<const TouchedPoint> points) noexcept;

// --- Pose of the dual arm's right base relative to the left one, from readings of the rigid handle

struct BaseCalibration {
  /// Ok; Truncated: fewer than twelve readings; BadPose: a reading is not finite; Singular: the readings are
  /// too similar to determine all six numbers, more positions and tilts are needed; Fault: no convergence,
  /// the start is too far off.
  Status status = Status::Fault;
  DualArmParameters parameters;       ///< given parameters with the right base corrected; unchanged unless Ok
  double rms_m = 0;                   ///< residual | |P_R - P_L| - L |
  double sigma_m = 0, sigma_rad = 0;  ///< standard deviation of the result in its worst direction
  int iterations = 0;
};

/// The gimbal centres are L apart at every pose of the handle: six unknowns (shift and rotation of the right
/// base), one equation per reading, least squares by Gauss-Newton from `parameters`. L is assumed to be
/// known. Allocates nothing; O(readings) in each of a few iterations.
VPS_DEVICE_API BaseCalibration calibrateBases(const DualArmParameters& parameters,
                                              std::span<const DualArmJoints> readings) noexcept;

}  // namespace vps::device
