// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/simulated_dual_arm.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace vps {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr double kGravity_m_s2 = 9.81;
// Below this joint speed dry friction fades linearly: about 2 mm/s at the handle, slower than a hand can hold
// still.
constexpr double kPlateSlip_rad_s = 2e-3, kLinkSlip_m_s = 2e-3, kRotorSlip_rad_s = 2e-2;
// Beyond it, in the workspace's corners, the gimbal nears its singularity, where the motor no longer brakes
// all turns.
constexpr double kTilt_rad = 0.5236;
// Motors give their peak until the mean square of their effort comes within this of the continuous limit's.
constexpr double kHeatBlend = 0.1;

Vec6 stacked(const Wrench& F) {
  Vec6 v;
  v << F.tau, F.f;
  return v;
}

Vec6 stacked(const Twist& V) {
  Vec6 v;
  v << V.w, V.v;
  return v;
}

double quantised(double value, double step) {
  return std::round(value / step) * step;
}

ArmJoints quantised(const ArmJoints& joints, const DualArmParameters& p) {
  return {quantised(joints.t1_rad, p.plate_step_rad), quantised(joints.t2_rad, p.plate_step_rad),
          quantised(joints.d3_m, p.link_step_m)};
}

double leastEigenvalue(const Mat3& m) {
  return Eigen::SelfAdjointEigenSolver<Mat3>(m).eigenvalues()[0];
}

// Least damping and dry friction of the handle over the workspace and handle directions within 45 deg. The
// sum of joint frictions |f_i v_i| is never less than the root of the sum of their squares, which an
// eigenvalue bounds.
void leastFriction(const DualArmParameters& p, DeviceLimits& limits) {
  const JointVector damping = jointVector(p.plate_damping_Nms, p.link_damping_Ns_per_m, p.rotor_damping_Nms);
  const JointVector coulomb = jointVector(p.plate_coulomb_Nm, p.link_coulomb_N, p.rotor_coulomb_Nm);
  const JointVector coulomb2 = coulomb.cwiseProduct(coulomb);
  limits.damping_Ns_per_m = limits.damping_Nms_per_rad = limits.coulomb_N = limits.coulomb_Nm = 1e9;
  for (int i = 0; i < 3 * 3 * 3 * 3 * 3; ++i) {
    const auto third = [i](int power) { return i / power % 3 - 1.0; };
    const Vec3 corner(third(1), third(3), third(9));
    const Vec3 tilt = Vec3(third(27), 0, third(81)).stableNormalized() * kTilt_rad;
    const Pose X_DH(rotationFromVector(tilt), Vec3(0.5 * p.workspace_m.cwiseProduct(corner)));
    JointMatrix J;
    if (handleJacobian(p, X_DH, J) != Status::Ok) continue;
    const Mat6 B = J.transpose() * damping.asDiagonal() * J, C = J.transpose() * coulomb2.asDiagonal() * J;
    limits.damping_Nms_per_rad =
        std::min(limits.damping_Nms_per_rad, leastEigenvalue(B.topLeftCorner<3, 3>()));
    limits.damping_Ns_per_m = std::min(limits.damping_Ns_per_m, leastEigenvalue(B.bottomRightCorner<3, 3>()));
    limits.coulomb_Nm = std::min(limits.coulomb_Nm, std::sqrt(leastEigenvalue(C.topLeftCorner<3, 3>())));
    limits.coulomb_N = std::min(limits.coulomb_N, std::sqrt(leastEigenvalue(C.bottomRightCorner<3, 3>())));
  }
}

}  // namespace

SimulatedDualArm::SimulatedDualArm(const SimulatedDualArmSettings& settings)
    : settings_(settings), X_DH_(settings.X_DH_start) {
  const DualArmParameters& p = settings_.arms;
  limits_.continuous_force_N = p.force_N;
  limits_.peak_force_N = p.force_peak_N;
  limits_.continuous_torque_Nm = p.torque_Nm;
  limits_.peak_torque_Nm = p.torque_peak_Nm;
  limits_.workspace_min_D = -0.5 * p.workspace_m;
  limits_.workspace_max_D = 0.5 * p.workspace_m;
  limits_.rate_hz = settings_.rate_hz;
  limits_.resolution_m = settings_.has_quantised_encoders ? p.resolution_m : 0;
  limits_.resolution_rad = settings_.has_quantised_encoders ? p.resolution_rad : 0;
  leastFriction(p, limits_);
  last_.X_DH = X_DH_;
}

void SimulatedDualArm::moveTo(const Pose& X_DH) noexcept {
  X_DH_ = X_DH;
  V_DH_ = {};
  has_read_ = has_stepped_ = false;
  last_ = {};
  last_.X_DH = X_DH;
}

DeviceSample SimulatedDualArm::read() noexcept {
  const double dt_s = time_s_ - last_.time_s;
  if (has_read_ && !(dt_s > 0)) return last_;
  DualArmJoints joints;
  Pose X_DH = X_DH_;
  Status status = handleJoints(settings_.arms, X_DH_, joints);
  if (status == Status::Ok && settings_.has_quantised_encoders) {
    joints.left = quantised(joints.left, settings_.arms);
    joints.right = quantised(joints.right, settings_.arms);
    joints.q3_rad = quantised(joints.q3_rad, settings_.arms.rotor_step_rad);
  }
  if (status == Status::Ok) status = handlePose(settings_.arms, joints, X_DH);
  if (status == Status::Ok && has_read_) {
    const double gain = 1 / (settings_.velocity_filter_s + dt_s);  // of a first-order filter, times dt
    last_.V_DH.v += gain * (X_DH.p - last_.X_DH.p - dt_s * last_.V_DH.v);
    last_.V_DH.w += gain * (rotationVector(X_DH.R * last_.X_DH.R.transpose()) - dt_s * last_.V_DH.w);
  }
  if (status == Status::Ok) last_.X_DH = X_DH;
  last_.time_s = time_s_;
  last_.status = status;
  has_read_ = true;
  return last_;
}

void SimulatedDualArm::write(const Wrench& F_Ho_D) noexcept {
  const DualArmParameters& p = settings_.arms;
  const Wrench wanted = F_Ho_D.isFinite() ? F_Ho_D : Wrench{};
  const double share = std::clamp((1 - heat_.maxCoeff()) / kHeatBlend, 0.0, 1.0);
  const JointVector limit = motorLimits(p, share);

  // The controller knows only the measured pose. It carries the handle first; what is left is for the hand.
  const Wrench carry{Vec3::Zero(), Vec3(0, 0, p.handle_kg * kGravity_m_s2)};
  JointVector bias, wish;
  efforts_.setZero();
  F_applied_ = {};
  if (motorEfforts(p, last_.X_DH, carry, bias) != Status::Ok) return;
  if (motorEfforts(p, last_.X_DH, wanted, wish) != Status::Ok) return;
  double scale = saturationScale(bias, wish, limit);
  const double force_N = p.force_N + share * (p.force_peak_N - p.force_N);
  const double torque_Nm = p.torque_Nm + share * (p.torque_peak_Nm - p.torque_Nm);
  scale = std::min(scale, force_N / std::max(force_N, wanted.f.norm()));
  scale = std::min(scale, torque_Nm / std::max(torque_Nm, wanted.tau.norm()));
  if (scale < 1) ++saturated_;
  efforts_ = (bias + scale * wish).cwiseMin(limit).cwiseMax(-limit);

  Wrench F;
  if (handleWrench(p, X_DH_, efforts_, F) == Status::Ok) F_applied_ = F + -carry;
}

SimulatedDualArm::Mat6 SimulatedDualArm::inertia(const JointMatrix& J) const noexcept {
  const DualArmParameters& p = settings_.arms;
  const JointVector joint_mass = jointVector(p.plate_kgm2, p.link_kg, p.rotor_kgm2);
  Mat6 M = J.transpose() * joint_mass.asDiagonal() * J;
  M.topLeftCorner<3, 3>() += X_DH_.R * p.handle_kgm2.asDiagonal() * X_DH_.R.transpose();
  M.bottomRightCorner<3, 3>().diagonal().array() += p.handle_kg;
  return M;
}

void SimulatedDualArm::step(double dt_s, const HandForce& hand) noexcept {
  const DualArmParameters& p = settings_.arms;
  JointMatrix J;
  if (handleJacobian(p, X_DH_, J) == Status::Ok) J_ = J;  // at a singularity: the last that was good

  const Mat6 M_arms = inertia(J_);
  if (!has_stepped_) M_before_ = M_arms;
  has_stepped_ = true;
  Mat6 M = M_arms;
  M.topLeftCorner<3, 3>().diagonal().array() += hand.inertia_kgm2;
  M.bottomRightCorner<3, 3>().diagonal().array() += hand.mass_kg;

  // Explicit: motors, weight, the hand's spring and damper as they would be at rest in the present pose.
  const Vec6 V = stacked(V_DH_);
  const Wrench weight{Vec3::Zero(), Vec3(0, 0, -p.handle_kg * kGravity_m_s2)};
  const Vec6 F_explicit =
      J_.transpose() * efforts_ + stacked(weight) + stacked(handWrench(hand, X_DH_, Twist{}));
  // The arms' inertia changes with the pose. Half its change is what keeps kinetic energy equal to work; the
  // other velocity-product terms do no work, and at a hand's speeds are below 0.01 N, so they are left out.
  const Vec6 momentum = M * V - 0.5 * (M_arms - M_before_) * V;

  // Implicit: (M + dt (B + friction) + dt^2 K) V' = momentum + dt F. Dry friction as a damper f_c / max(|q'|,
  // slip), found by iterating a few times on q'.
  Mat6 hand_side = Mat6::Zero();
  hand_side.topLeftCorner<3, 3>() = hand.b_Nms_per_rad + dt_s * hand.k_Nm_per_rad;
  hand_side.bottomRightCorner<3, 3>() = hand.b_Ns_per_m + dt_s * hand.k_N_per_m;
  const JointVector viscous = jointVector(p.plate_damping_Nms, p.link_damping_Ns_per_m, p.rotor_damping_Nms);
  const JointVector coulomb = jointVector(p.plate_coulomb_Nm, p.link_coulomb_N, p.rotor_coulomb_Nm);
  const JointVector slip = jointVector(kPlateSlip_rad_s, kLinkSlip_m_s, kRotorSlip_rad_s);
  Vec6 V_next = V;
  Mat6 friction;
  for (int i = 0; i < 3; ++i) {
    const JointVector rate = J_ * V_next;
    const JointVector damper = viscous + coulomb.cwiseQuotient(rate.cwiseAbs().cwiseMax(slip));
    friction = J_.transpose() * damper.asDiagonal() * J_;
    V_next = (M + dt_s * (hand_side + friction)).llt().solve(momentum + dt_s * F_explicit);
  }
  if (!V_next.allFinite()) return;  // a hand that is not finite moves nothing

  const Twist V_before = V_DH_;
  V_DH_ = {V_next.head<3>(), V_next.tail<3>()};
  X_DH_ = Pose(Quat(rotationFromVector(dt_s * V_DH_.w) * X_DH_.R), Vec3(X_DH_.p + dt_s * V_DH_.v));
  time_s_ += dt_s;
  M_before_ = M_arms;
  F_hand_ = vps::handWrench(hand, X_DH_, V_DH_);
  F_hand_.f -= hand.mass_kg / dt_s * (V_DH_.v - V_before.v);
  F_hand_.tau -= hand.inertia_kgm2 / dt_s * (V_DH_.w - V_before.w);
  kinetic_J_ = 0.5 * V_next.dot(M * V_next);
  friction_J_ += dt_s * V_next.dot(friction * V_next);
  const JointVector load = efforts_.cwiseQuotient(motorLimits(p, 0));
  heat_ += dt_s / settings_.thermal_s * (load.cwiseProduct(load) - heat_);
}

}  // namespace vps
