// SPDX-License-Identifier: BSD-3-Clause
// Where a device stands in a room, from points that its handle touched and whose places in the room are
// known.
#pragma once

#include <cstddef>
#include <span>

#include "vps/errors.h"
#include "vps/pose.h"
#include "vps_device/export.h"

namespace vps::device {

/// A point touched by the handle's origin.
struct TouchedPoint {
  Vec3 p_D = Vec3::Zero();  ///< as the device reads it
  Vec3 p_S = Vec3::Zero();  ///< where it is in the room
};

struct Placement {
  /// Ok; Truncated: fewer than three points; BadPose: one is not finite; Singular: they lie on a line, which
  /// leaves a turn about it open.
  Status status = Status::Truncated;
  Pose X_SD;
  double rms_m = 0, greatest_m = 0;  ///< residuals | X_SD p_D - p_S |
  std::size_t worst = 0;             ///< index of the point with the greatest one
};

/// The pose with the least sum of squared residuals. O(points). Source: Kabsch 1976; Umeyama 1991, for its
/// sign of reflections.
VPS_DEVICE_API Placement fitPlacement(std::span<const TouchedPoint> points) noexcept;

}  // namespace vps::device
