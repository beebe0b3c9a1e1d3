// SPDX-License-Identifier: BSD-3-Clause
// The last check before hardware: a wrench that is not finite, too strong, too sudden, or computed from a
// lost device does not pass.
#pragma once

#include <cstdint>

#include "vps_device/device.h"
#include "vps_device/export.h"

namespace vps::device {

struct SafetyLimits {
  double force_N = 30;
  double torque_Nm = 2.5;
  /// Greatest rate of change of force. assumed: full force in 2 ms; a coupling of 3 kN/m that is struck at 1
  /// m/s needs a fifth of this rate
  double slew_N_per_s = 15000;
  double slew_Nm_per_s = 1250;
  double jump_m = 0.02;  ///< greatest step between samples. assumed: no hand moves at 20 m/s (at 1 kHz)
  double jump_rad = 0.3;
  double rearm_s = 0.2;  ///< force returns over this time after re-arming. assumed: longer than a startle
};

enum class SafetyFault {
  None,
  BadWrench,
  BadPose,
  Jump,
  DeviceLost,
  ClockBackwards,
  BadGains,
  PhysicsStalled,  ///< the state of the part in hand is too old
};
VPS_DEVICE_API const char* toText(SafetyFault fault) noexcept;
/// The event that reports a fault; not for None.
VPS_DEVICE_API DeviceEventKind eventOf(SafetyFault fault) noexcept;

struct SafetyState {
  SafetyFault fault = SafetyFault::None;  ///< latched until rearm()
  std::uint64_t faults = 0;               ///< number of faults so far
  std::uint64_t limited = 0;              ///< ticks in which force or torque was limited
  std::uint64_t slewed = 0;               ///< ticks in which the change was limited
};

class VPS_DEVICE_API SafetyGuard {
 public:
  explicit SafetyGuard(const SafetyLimits& limits = {}) : limits_(limits) {}

  /// The wrench that may go to the motors: finite, |f| and |tau| within limits (both scaled by the same
  /// factor, so that the direction is kept), changing no faster than the slew limits. A fault sets the wrench
  /// to zero at once, until rearm().
  Wrench guard(const DeviceSample& sample, const Wrench& wanted, double dt_s) noexcept;

  /// Clears a fault; force returns over rearm_s.
  void rearm() noexcept;

  /// Latches a fault that other code has found.
  void latchFault(SafetyFault fault) noexcept { trip(fault); }

  [[nodiscard]] const SafetyState& state() const noexcept { return state_; }

 private:
  void trip(SafetyFault fault) noexcept;

  SafetyLimits limits_;
  SafetyState state_;
  Wrench last_;
  Pose X_last_;
  double time_last_s_ = 0;
  bool has_pose_ = false;
  double ramp_ = 1;
};

}  // namespace vps::device
