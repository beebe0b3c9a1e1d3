// SPDX-License-Identifier: BSD-3-Clause
// How long a motor may give its peak: the mean square of its effort, as its winding's heat, stays below that
// of the continuous limit.
#pragma once

#include "vps_device/dual_arm.h"
#include "vps_device/export.h"

namespace vps::device {

class VPS_DEVICE_API MotorHeat {
 public:
  explicit MotorHeat(const DualArmParameters& parameters) noexcept;

  /// `efforts` held for dt_s.
  void add(const JointVector& efforts, double dt_s) noexcept;

  /// What each motor may give now: its peak while it is cool, falling to the continuous limit as it warms.
  [[nodiscard]] JointVector limits() const noexcept;
  /// Share of the peak beyond continuous that the warmest motor may give, 0 to 1.
  [[nodiscard]] double peakShare() const noexcept;
  /// Heat of each motor: 1 is what the continuous limit settles at, and the most that is allowed.
  [[nodiscard]] const JointVector& heat() const noexcept { return heat_; }

 private:
  JointVector continuous_, peak_;
  JointVector heat_ = JointVector::Zero();
  double thermal_s_;
};

}  // namespace vps::device
