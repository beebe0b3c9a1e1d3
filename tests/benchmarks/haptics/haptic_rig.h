// SPDX-License-Identifier: BSD-3-Clause
// The simulated arm, the haptic loop and a Bullet world with VPS contact, in lockstep, with a hand that moves
// a part.
#pragma once

#include "dynamics/world.h"
#include "vps_bullet/coupling.h"
#include "vps_device/dual_arm/simulated_dual_arm.h"
#include "vps_device/gains.h"
#include "vps_device/loop.h"

namespace vps::bench {

struct RigSettings {
  dynamics::SceneSettings scene;
  device::SimulatedDualArmSettings device = device::idealDualArm();
  bool has_gravity = false;
};

/// The settings of the real arm, with encoders, structure and delay.
inline device::SimulatedDualArmSettings realDualArm() {
  return {};
}

/// Haptics and physics at 1 kHz, gains as derived for the device. The hand moves the part's centre of mass.
class HapticRig {
 public:
  explicit HapticRig(const RigSettings& settings);

  dynamics::World& world() { return world_; }
  /// Grasps a part at its present pose, at rest.
  void take(const dynamics::Placed& held);
  /// Advances by one millisecond, in which the hand pulls the grasp frame, with the stiffness of a firm grip,
  /// to a position and a rotation relative to the grasp.
  void lead(const Vec3& p_WG, const Vec3& turn_rad, const Twist& V_WG);

  [[nodiscard]] const device::SimulatedDualArm& arm() const { return arm_; }
  [[nodiscard]] const device::HapticLoop& loop() const { return loop_; }
  [[nodiscard]] const CouplingGains& gains() const { return loop_.settings().gains; }
  /// The true pose of the hand's grasp frame, and of the part's grasp frame.
  [[nodiscard]] Pose trueGrasp() const { return loop_.toGrasp(arm_.truePose()); }
  [[nodiscard]] const CouplingState& part() const { return part_; }
  /// The wrench of the motors on the hand, without the handle's weight, in W, which is D here.
  [[nodiscard]] const Wrench& felt() const { return arm_.appliedWrench(); }

  static constexpr double kStep_s = dynamics::World::kStep_s;

 private:
  dynamics::World world_;
  device::SimulatedDualArm arm_;
  device::CouplingPort port_;
  device::HapticLoop loop_;
  bullet::CouplingConstraint* coupling_ = nullptr;  // owned by world_
  CouplingState part_;
  Mat3 R_WG_taken_ = Mat3::Identity();
};

}  // namespace vps::bench
