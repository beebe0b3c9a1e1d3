// SPDX-License-Identifier: BSD-3-Clause
#include "haptic_rig.h"

#include "vps_bullet/convert.h"

namespace vps::bench {

namespace {

device::LoopSettings settingsFor(const device::SimulatedDualArm& arm) {
  device::LoopSettings settings;
  settings.period_s = HapticRig::kStep_s;
  settings.gains =
      device::deriveGains(arm.limits(), {1 / HapticRig::kStep_s, 1 / HapticRig::kStep_s, 0, 1, 1});
  settings.extrapolates_part = true;  // as in scenes
  return settings;
}

}  // namespace

HapticRig::HapticRig(const RigSettings& settings)
    : world_(settings.scene), arm_(settings.device), loop_(arm_, port_, settingsFor(arm_)) {
  if (!settings.has_gravity) world_.setGravity(Vec3::Zero());
}

void HapticRig::take(const dynamics::Placed& held) {
  auto coupling = std::make_unique<bullet::CouplingConstraint>(*held.body, Pose{}, gains());
  coupling_ = coupling.get();
  world_.addConstraint(std::move(coupling));
  loop_.grasp(bullet::fromBt(held.body->getWorldTransform()));
  part_ = coupling_->partState();
  part_.is_coupled = true;
  R_WG_taken_ = part_.X_W.R;
}

void HapticRig::lead(const Vec3& p_WG, const Vec3& turn_rad, const Twist& V_WG) {
  port_.physics.write({part_, 0, {}, {}});
  loop_.tick();
  device::HandForce hand;
  hand.X_eq = Pose(Mat3(rotationFromVector(turn_rad) * R_WG_taken_), p_WG);
  hand.V_eq = V_WG;
  hand.mass_kg = 1.5;  // as the virtual operator of vps_device/operator.h
  hand.inertia_kgm2 = 0.004;
  hand.k_N_per_m = 4000 * Mat3::Identity();
  hand.b_Ns_per_m = 150 * Mat3::Identity();
  hand.k_Nm_per_rad = 10 * Mat3::Identity();
  hand.b_Nms_per_rad = 0.4 * Mat3::Identity();
  constexpr int kSubSteps = 4;  // see tests/support/device/sampled_wall.h
  for (int i = 0; i < kSubSteps; ++i) arm_.step(kStep_s / kSubSteps, loop_.toDevice(hand));
  coupling_->setTarget(port_.haptic.read().proxy);
  world_.step();
  part_ = coupling_->partState();
  part_.is_coupled = true;
}

}  // namespace vps::bench
