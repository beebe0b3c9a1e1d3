// SPDX-License-Identifier: BSD-3-Clause
// Limits the duration of peak effort: the low-passed square of a motor's effort, which models its winding's
// temperature, stays below that of the continuous limit.
#pragma once

#include "vps_device/dual_arm/kinematics.h"
#include "vps_device/export.h"

namespace vps::device {

class VPS_DEVICE_API MotorHeat {
 public:
  explicit MotorHeat(const DualArmParameters& parameters) noexcept;

  /// `efforts` held for dt_s.
  void add(const JointVector& efforts, double dt_s) noexcept;

  /// Present limit of each motor: the peak while it is cool, falling to the continuous limit as it warms.
  [[nodiscard]] JointVector limits() const noexcept;
  /// Share of the range from continuous to peak that the warmest motor may use, 0 to 1.
  [[nodiscard]] double peakShare() const noexcept;
  /// Heat of each motor: 1 is the steady state at the continuous limit, and the greatest allowed.
  [[nodiscard]] const JointVector& heat() const noexcept { return heat_; }

 private:
  JointVector continuous_, peak_;
  JointVector heat_ = JointVector::Zero();
  double thermal_s_;
};

}  // namespace vps::device
