// SPDX-License-Identifier: BSD-3-Clause
// Turns the dual arm's hardware into a haptic device: encoders to the handle's pose, a wrench to motor
// efforts, and checks of both.
//
//   encoders -> offsets -> checks -> handle's pose, velocity
//   wrench -> limits -> + handle's weight -> motors
#pragma once

#include "vps_device/device.h"
#include "vps_device/dual_arm/hardware.h"
#include "vps_device/export.h"

namespace vps::device {

struct DualArmControllerSettings {
  DualArmParameters arms;
  double rate_hz = 1000;               ///< rate of read-write cycles
  bool has_quantised_encoders = true;  ///< true: limits() contains the encoders' resolution; false: 0
  bool is_rigid = false;               ///< the structure has no deflection under the handle's weight
  bool needs_calibration = false;      ///< incremental encoders: no wrench before calibrate()
};

/// A fault is latched: until rearm(), read() returns Status::Fault and no wrench is given. After PeerLost the
/// motors still carry the handle; after any other fault they are switched off.
class VPS_DEVICE_API DualArmController final : public Device {
 public:
  /// hardware and events outlive the controller; events may be null.
  DualArmController(DualArmHardware& hardware, const DualArmControllerSettings& settings,
                    DeviceEventQueue* events = nullptr);

  DeviceSample read() noexcept override;
  void write(const Wrench& F_Ho_D) noexcept override;
  [[nodiscard]] DeviceLimits limits() const noexcept override { return limits_; }
  [[nodiscard]] std::string_view name() const noexcept override { return "dual_arm"; }
  void rearm() noexcept override;

  /// The first calibration: with the handle in its cradle at X_DH, motors off, sets the encoders' zero from
  /// the mean of some readings. BadPose or Singular for a cradle that is out of reach, Fault for readings
  /// that are not finite; the zero then stays.
  Status calibrate(const Pose& X_DH, int readings = 64) noexcept;

  /// Accepts the next reading at any pose, after the handle was moved by other means.
  void forgetMotion() noexcept;

  [[nodiscard]] bool hasFault() const noexcept { return has_fault_; }
  [[nodiscard]] DeviceEventKind fault() const noexcept { return fault_; }  ///< valid only while hasFault()
  [[nodiscard]] const JointVector& efforts() const noexcept {
    return efforts_;
  }  ///< the last command to the motors
  [[nodiscard]] const MotorHeat& heat() const noexcept { return heat_; }
  [[nodiscard]] unsigned long saturatedWrites() const noexcept { return saturated_; }

 private:
  void trip(DeviceEventKind kind, double value) noexcept;
  void warn(DeviceEventKind kind, bool is_so, double value) noexcept;
  bool isSane(const DualArmReading& reading) noexcept;
  bool isWhole(const JointVector& joints, double dt_s) noexcept;
  [[nodiscard]] Status poseOf(const JointVector& joints, Pose& X_DH) const noexcept;
  void follow(const Pose& X_DH, double dt_s) noexcept;
  void watchJoints(const JointVector& joints) noexcept;

  DualArmControllerSettings settings_;
  DualArmHardware* hardware_;
  DeviceEventQueue* events_;
  DeviceLimits limits_;
  MotorHeat heat_;
  JointVector offset_ = JointVector::Zero();
  JointVector efforts_ = JointVector::Zero();
  DeviceSample last_;
  JointVector joints_ = JointVector::Zero();
  double silent_s_ = 0, unwritten_s_ = 0;
  bool has_read_ = false, has_time_ = false, has_written_ = false, is_calibrated_ = true;
  bool has_fault_ = false;
  DeviceEventKind fault_ = DeviceEventKind::BadEncoder;
  unsigned warned_ = 0;  ///< one bit per active warning
  unsigned long saturated_ = 0;
};

/// The device's limits at the rate `rate_hz`, for gains and safety. Damping and dry friction are the least
/// over the workspace, with the handle rotated by at most 30 deg from its straight direction.
VPS_DEVICE_API DeviceLimits dualArmLimits(const DualArmParameters& parameters, double rate_hz,
                                          bool has_quantised_encoders);

}  // namespace vps::device
