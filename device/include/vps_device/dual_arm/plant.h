// SPDX-License-Identifier: BSD-3-Clause
// The dual arm's mechanics in simulated time: inertia, friction, an elastic structure, stops, delayed motors,
// and quantised encoders.
//
//   motor, capstan, encoder --[ structure: spring and damper ]-- link, gimbal, rigid handle -- hand
//   motor_share of inertia;      each joint                      the rest of it; weight; stops
//   friction
#pragma once

#include <array>

#include "vps_device/dual_arm/hardware.h"
#include "vps_device/export.h"
#include "vps_device/random.h"
#include "vps_device/simulated_device.h"

namespace vps::device {

struct DualArmPlantSettings {
  DualArmParameters arms;
  bool has_quantised_encoders = true;  ///< false: exact readings, without noise
  bool is_rigid = false;               ///< true: no elasticity
  std::uint64_t seed = 1;              ///< seed of the encoders' noise
  Pose X_DH_start;
};

/// Deterministic; nothing allocates after construction.
class VPS_DEVICE_API DualArmPlant final : public DualArmHardware {
 public:
  explicit DualArmPlant(const DualArmPlantSettings& settings = {});

  DualArmReading read() noexcept override;
  /// Takes effect after the parameters' delay_ticks further calls. Efforts are limited to a motor's peak; a
  /// value that is not finite counts as zero.
  void drive(const JointVector& efforts) noexcept override;

  /// Advances by dt_s > 0 with the hand `hand` (in D) on the handle. Springs, dampers and friction are solved
  /// implicitly: stable at any stiffness.
  void step(double dt_s, const HandForce& hand) noexcept;

  /// Puts the handle at X_DH, at rest; the motors carry its weight.
  void moveTo(const Pose& X_DH) noexcept;

  [[nodiscard]] const DualArmPlantSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] const Pose& pose() const noexcept { return X_DH_; }
  [[nodiscard]] const Twist& twist() const noexcept { return V_DH_; }
  [[nodiscard]] double time_s() const noexcept { return time_s_; }
  /// The acting efforts, after delay, limits and watchdog.
  [[nodiscard]] const JointVector& efforts() const noexcept { return efforts_; }
  [[nodiscard]] const MotorHeat& heat() const noexcept { return heat_; }
  /// Wrench of the hand on the handle in the last step, in D.
  [[nodiscard]] const Wrench& lastHandWrench() const noexcept { return F_hand_; }
  [[nodiscard]] double kinetic_J() const noexcept {
    return kinetic_J_;
  }  ///< kinetic energy of arms, handle and hand
  [[nodiscard]] double structure_J() const noexcept {
    return structure_J_;
  }  ///< stored in the elastic structure and the stops
  [[nodiscard]] double friction_J() const noexcept { return friction_J_; }  ///< dissipated so far, >= 0

 private:
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  using Row6 = Eigen::Matrix<double, 1, 6>;

  struct Motors;  ///< result of a step on the motors' side
  [[nodiscard]] Mat6 handleInertia() const noexcept;
  [[nodiscard]] Motors motorsOf(double dt_s) const noexcept;
  double addStops(double dt_s, const Vec6& V_next, Mat6& A, Vec6& b) const noexcept;
  [[nodiscard]] Vec6 solve(double dt_s, const HandForce& hand, const Motors& motors, JointVector& damper,
                           double& stops_J) const noexcept;
  void move(double dt_s, const Vec6& V_next, const Motors& motors, const JointVector& damper) noexcept;

  static constexpr std::size_t kMaxDelay = 9;

  DualArmPlantSettings settings_;
  MotorHeat heat_;
  Random random_;
  JointVector motor_inertia_, link_inertia_, viscous_, coulomb_;
  Pose X_DH_;
  Twist V_DH_;
  HandleMotion motion_;  ///< motion at the handle's pose; at a singularity, at the last valid pose
  JointVector link_rate_ = JointVector::Zero();  ///< joint rates on the handle's side, at the last step
  JointVector motor_ = JointVector::Zero();      ///< joints on the motors' side
  JointVector motor_rate_ = JointVector::Zero();
  std::array<JointVector, kMaxDelay> commands_;  ///< newest first
  JointVector efforts_ = JointVector::Zero();
  double time_s_ = 0, command_s_ = 0;
  Wrench F_hand_;
  Mat6 M_handle_ = Mat6::Zero();  ///< inertia of the handle alone, at the last step
  double kinetic_J_ = 0, structure_J_ = 0, friction_J_ = 0;
};

}  // namespace vps::device
