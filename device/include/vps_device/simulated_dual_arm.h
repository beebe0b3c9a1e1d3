// SPDX-License-Identifier: BSD-3-Clause
// A dual-arm device in simulated time: rigid handle, reflected arms, friction, encoders and motors with
// limits.
#pragma once

#include "vps_device/device.h"
#include "vps_device/dual_arm.h"
#include "vps_device/hand_force.h"

namespace vps {

struct SimulatedDualArmSettings {
  DualArmParameters arms;
  bool has_quantised_encoders = true;
  double rate_hz = 1000;  ///< of read-write cycles; the velocity filter follows it
  double velocity_filter_s =
      2e-3;               ///< time constant of the velocity estimate. assumed: one encoder step then gives
                          ///< less than 20 mm/s at 1 kHz, and the lag stays below the coupling's own
  double thermal_s = 10;  ///< time constant of motor heat, for peak against continuous. assumed
  Pose X_DH_start;
};

/// Deterministic; nothing allocates after construction.
class SimulatedDualArm final : public Device {
 public:
  explicit SimulatedDualArm(const SimulatedDualArmSettings& settings = {});

  /// True pose -> joints -> encoders -> forward kinematics. Velocity: filtered difference of the measured
  /// poses.
  DeviceSample read() noexcept override;

  /// Wrench -> motor efforts (with the handle's weight) -> limits -> wrench that step() applies.
  void write(const Wrench& F_Ho_D) noexcept override;

  [[nodiscard]] DeviceLimits limits() const noexcept override { return limits_; }
  [[nodiscard]] std::string_view name() const noexcept override { return "dual_arm"; }

  /// Advances the plant by dt_s with the hand `hand` (in D) on the handle. The hand's spring and damper, and
  /// friction, are solved implicitly: stable at any stiffness. dt_s > 0.
  void step(double dt_s, const HandForce& hand) noexcept;

  /// Puts the handle elsewhere, at rest; the next read() starts afresh. For calibration and tests.
  void moveTo(const Pose& X_DH) noexcept;

  /// The truth, for tests and for the operator's own senses; the loop sees only read().
  [[nodiscard]] const Pose& truePose() const noexcept { return X_DH_; }
  [[nodiscard]] const Twist& trueTwist() const noexcept { return V_DH_; }
  [[nodiscard]] double time_s() const noexcept { return time_s_; }
  /// What the motors give to the hand after limits, less the handle's weight, in D.
  [[nodiscard]] const Wrench& appliedWrench() const noexcept { return F_applied_; }
  /// What the hand gave the handle in the last step, in D.
  [[nodiscard]] const Wrench& lastHandWrench() const noexcept { return F_hand_; }
  [[nodiscard]] double kinetic_J() const noexcept { return kinetic_J_; }
  [[nodiscard]] double friction_J() const noexcept { return friction_J_; }  ///< dissipated so far, >= 0
  [[nodiscard]] unsigned long saturatedWrites() const noexcept { return saturated_; }

 private:
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  [[nodiscard]] Mat6 inertia(const JointMatrix& J) const noexcept;

  SimulatedDualArmSettings settings_;
  DeviceLimits limits_;
  Pose X_DH_;
  Twist V_DH_;
  double time_s_ = 0;
  Wrench F_applied_, F_hand_;
  JointMatrix J_ = JointMatrix::Zero();
  Mat6 M_before_ = Mat6::Zero();
  JointVector heat_ = JointVector::Zero();  ///< mean square of effort / continuous limit
  JointVector efforts_ = JointVector::Zero();
  double kinetic_J_ = 0, friction_J_ = 0;
  unsigned long saturated_ = 0;
  bool has_read_ = false, has_stepped_ = false;
  DeviceSample last_;
};

}  // namespace vps
