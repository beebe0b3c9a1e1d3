// SPDX-License-Identifier: BSD-3-Clause
// What drives the dual arm's motors and reads its encoders: hardware, or the plant that stands for it.
#pragma once

#include "vps_device/dual_arm.h"
#include "vps_device/export.h"

namespace vps::device {

/// The encoders at one instant.
struct DualArmReading {
  DualArmJoints joints;
  double time_s = 0;     ///< of the hardware's clock; the same as before: nothing new
  bool has_left = true;  ///< false: the left arm does not answer
  bool has_right = true;
};

/// One thread calls read() and drive() in turn; neither throws, allocates or waits.
class VPS_DEVICE_API DualArmHardware {
 public:
  virtual ~DualArmHardware() = default;

  virtual DualArmReading read() noexcept = 0;

  /// Motor efforts in joint order [N m, N], held until the next. The hardware lets go of its motors by itself
  /// when none comes for its watchdog's time.
  virtual void drive(const JointVector& efforts) noexcept = 0;

 protected:
  DualArmHardware() = default;
  DualArmHardware(const DualArmHardware&) = default;
  DualArmHardware& operator=(const DualArmHardware&) = default;
};

}  // namespace vps::device
