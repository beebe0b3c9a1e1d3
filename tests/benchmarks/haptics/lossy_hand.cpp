// SPDX-License-Identifier: BSD-3-Clause
#include "lossy_hand.h"

#include <algorithm>
#include <cmath>

#include "vps_device/dual_arm/kinematics.h"
#include "vps_device/dual_arm/statics.h"

namespace vps::bench {

device::DeviceSample LossyDevice::read() noexcept {
  const device::DeviceSample sample = inner_->read();
  if (!has_sample_ || random_.uniform() >= connection_.lost || sample.status != Status::Ok) arrived_ = sample;
  has_sample_ = true;
  return arrived_;
}

void LossyDevice::write(const Wrench& F) noexcept {
  std::rotate(sent_.begin(), sent_.end() - 1, sent_.end());
  sent_[0] = F;
  if (random_.uniform() >= connection_.lost) held_ = sent_[static_cast<std::size_t>(connection_.delay_ticks)];
  inner_->write(held_);
}

device::DeviceLimits LossyDevice::limits() const noexcept {
  device::DeviceLimits limits = inner_->limits();
  limits.delay_s += connection_.delay_ticks / limits.rate_hz;
  return limits;
}

void TrueEnergyBalance::update(double now_J) {
  balance_J = now_J;
  least_J = std::min(least_J, balance_J);
  injected_J = std::max(injected_J, balance_J - least_J);
}

LossyHand::LossyHand(const scenes::Scene& scene, const Connection& connection)
    : scene_(scene),
      hand_(scenes::simulatedHand(scene)),
      arm_(dynamic_cast<device::SimulatedDualArm&>(hand_->device())),
      device_(arm_, connection),
      limits_(arm_.limits()),
      ticks_per_step_(std::lround(scene.fidelity.haptic_rate_hz / scene.fidelity.physics_rate_hz)) {}

void LossyHand::prepare(const device::OperatorTask& task, std::size_t step, double now_s) {
  hand_->prepare(task, step, now_s);
  const auto& part = scene_.parts[scene_.steps[step].part].part;
  next_ = {task.X_PG, bullet::makeBodyFrame(massProperties(part.mesh), part.material.density_kg_m3)};
}

void LossyHand::begin() {
  hand_->begin();
  held_ = next_;
  tick_ = 0;
  is_holding_ = is_new_ = true;
}

void LossyHand::goBack(std::size_t next) {
  hand_->goBack(next);
  is_holding_ = false;  // the energy of the springs is dropped
}

double LossyHand::stored_J(const device::HeldPart& part, const device::HapticLoop& loop) const {
  const Pose X_WB = part.X_WP * held_.body.X_PB;
  const Vec3 v = part.V_WP.v + part.V_WP.w.cross(X_WB.p - part.X_WP.p),
             w_B = X_WB.R.transpose() * part.V_WP.w;
  const Pose X_WG = part.X_WP * held_.X_PG, X_hand = loop.toGrasp(poseAtMotors());
  const CouplingGains& gains = loop.settings().gains;
  // The force of a spring is constant beyond its limit.
  const auto spring = [](double k, double stretch, double most) {
    const double elastic = std::min(stretch, most / k);
    return 0.5 * k * elastic * elastic + most * (stretch - elastic);
  };
  return 0.5 * held_.body.mass_kg * v.squaredNorm() + 0.5 * w_B.cwiseAbs2().dot(held_.body.inertia_kg_m2) -
         held_.body.mass_kg * scene_.gravity_W.dot(X_WB.p) + arm_.structure_J() +
         spring(gains.k_N_per_m, (X_hand.p - X_WG.p).norm(), gains.max_force_N) +
         spring(gains.k_Nm_per_rad, rotationVector(X_hand.R * X_WG.R.transpose()).norm(),
                gains.max_torque_Nm);
}

// The handle's pose as the encoders measure it: the arms deflect by the motor efforts in excess of the
// handle's weight.
Pose LossyHand::poseAtMotors() const {
  const device::DualArmParameters& p = arm_.plant().settings().arms;
  const Pose& X_DH = arm_.truePose();
  device::DualArmJoints joints;
  device::JointVector carry;
  Pose X_seen;
  if (device::handleJoints(p, X_DH, joints) != Status::Ok ||
      device::motorEfforts(p, X_DH, -device::handleWeight(p), carry) != Status::Ok)
    return X_DH;
  const device::JointVector bend =
      (arm_.plant().efforts() - carry).cwiseQuotient(device::structureStiffness(p, device::toVector(joints)));
  return device::handlePose(p, device::fromVector(device::toVector(joints) + bend), X_seen) == Status::Ok
             ? X_seen
             : X_DH;
}

// The motors' present wrench on the hand, less the handle's weight, in D.
Wrench LossyHand::actingWrench() const {
  const device::DualArmParameters& p = arm_.plant().settings().arms;
  Wrench F;
  if (device::handleWrench(p, arm_.truePose(), arm_.plant().efforts(), F) != Status::Ok) return {};
  F += device::handleWeight(p);
  return F;
}

void LossyHand::step(const device::HeldPart& part, const device::HapticLoop& loop, double dt_s) {
  const device::WorkspaceMap& map = loop.settings().map;
  if (is_holding_ && tick_++ % ticks_per_step_ == 0) {  // the state of the part is that of this tick
    const double now_J = work_J_ - dissipated_J_ * map.scale / map.force_scale + stored_J(part, loop);
    if (is_new_) start_J_ = now_J - energy_.balance_J;
    is_new_ = false;
    energy_.update(now_J - start_J_);
  }
  constexpr int kSubSteps = 4;
  for (int i = 0; i < kSubSteps; ++i) {
    const Pose before = arm_.truePose();
    hand_->step(part, loop, dt_s / kSubSteps);
    const Twist shift{rotationVector(arm_.truePose().R * before.R.transpose()),
                      Vec3(arm_.truePose().p - before.p)};
    work_J_ += power(map.toScene(actingWrench()), map.toScene(shift));
    dissipated_J_ += (limits_.damping_Ns_per_m * shift.v.squaredNorm() +
                      limits_.damping_Nms_per_rad * shift.w.squaredNorm()) /
                     (dt_s / kSubSteps);
  }
}

}  // namespace vps::bench
