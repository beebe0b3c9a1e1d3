// SPDX-License-Identifier: BSD-3-Clause
// The dual arm's motors and encoders: their interface, which hardware drivers and the simulated plant
// implement, and the heat of the motors.
#pragma once

#include "vps_device/dual_arm/kinematics.h"
#include "vps_device/export.h"

namespace vps::device {

/// The encoders at one instant.
struct DualArmReading {
  DualArmJoints joints;
  double time_s = 0;     ///< time by the hardware's clock; an unchanged time means no new reading
  bool has_left = true;  ///< false: the left arm does not answer
  bool has_right = true;
};

/// One thread calls read() and drive() in turn; neither throws, allocates or waits.
class VPS_DEVICE_API DualArmHardware {
 public:
  virtual ~DualArmHardware() = default;

  virtual DualArmReading read() noexcept = 0;

  /// Motor efforts in joint order [N m, N], held until the next call. The hardware switches its motors off by
  /// itself when no command arrives for its watchdog's time.
  virtual void drive(const JointVector& efforts) noexcept = 0;

 protected:
  DualArmHardware() = default;
  DualArmHardware(const DualArmHardware&) = default;
  DualArmHardware& operator=(const DualArmHardware&) = default;
};

/// Limits the duration of peak effort: the low-passed square of a motor's effort, which models the
/// temperature of its winding, stays below that of the continuous limit.
class VPS_DEVICE_API MotorHeat {
 public:
  explicit MotorHeat(const DualArmParameters& parameters) noexcept;

  /// Adds the heat of `efforts`, held for dt_s.
  void add(const JointVector& efforts, double dt_s) noexcept;

  /// Present limit of each motor: the peak while the motor is cool, falling to the continuous limit as the
  /// motor warms.
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
