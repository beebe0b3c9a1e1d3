// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/dual_arm/plant.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "vps_device/dual_arm/statics.h"

namespace vps::device {
namespace {

// Below these joint speeds dry friction is proportional to the speed: about 2 mm/s at the handle, slower than
// the tremor of a hand.
constexpr double kPlateSlip_rad_s = 2e-3, kLinkSlip_m_s = 2e-3, kRotorSlip_rad_s = 2e-2;
constexpr int kIterations = 3;  // iterations for friction and stops, which depend on the unknown speed

template <typename Pair>
Eigen::Matrix<double, 6, 1> stacked(const Pair& turn, const Pair& line) {
  Eigen::Matrix<double, 6, 1> v;
  v << turn, line;
  return v;
}

Eigen::Matrix<double, 6, 1> stacked(const Wrench& F) {
  return stacked(F.tau, F.f);
}

// The handle's rotation about its own axis is periodic.
JointVector stretchOf(const JointVector& motor, const JointVector& joints) {
  JointVector stretch = motor - joints;
  stretch[6] = std::remainder(stretch[6], 2 * std::numbers::pi);
  return stretch;
}

double rounded(double value, double step) {
  return std::round(value / step) * step;
}

}  // namespace

// Implicit Euler of each motor's side, with u the handle side's rate:
//   (I + dt f + g) w' = I w + dt tau - dt K e + g u,   g = dt B + dt^2 K,   e = stretch
// The handle's side then receives dt K e + g (w' - u), expressed as a resistance to u and an impulse.
struct DualArmPlant::Motors {
  bool is_rigid;
  double dt_s;
  JointVector inertia, drive, g, alone, pull;

  [[nodiscard]] JointVector whole(const JointVector& damper) const { return inertia + dt_s * damper + g; }
  [[nodiscard]] JointVector rate(const JointVector& u, const JointVector& damper) const {
    return is_rigid ? u : JointVector((alone + g.cwiseProduct(u)).cwiseQuotient(whole(damper)));
  }
  [[nodiscard]] JointVector resistance(const JointVector& damper) const {
    if (is_rigid) return dt_s * damper;
    return g.cwiseProduct(inertia + dt_s * damper).cwiseQuotient(whole(damper));
  }
  [[nodiscard]] JointVector impulse(const JointVector& damper) const {
    return is_rigid ? drive : JointVector(pull + g.cwiseProduct(alone).cwiseQuotient(whole(damper)));
  }
};

DualArmPlant::DualArmPlant(const DualArmPlantSettings& settings)
    : settings_(settings), heat_(settings.arms), random_(settings.seed) {
  const DualArmParameters& p = settings_.arms;
  const JointVector inertia = jointVector(p.plate_kgm2, p.link_kg, p.rotor_kgm2);
  const double motor_share = settings_.is_rigid ? 0 : p.motor_share;
  motor_inertia_ = motor_share * inertia;
  link_inertia_ = (1 - motor_share) * inertia;
  viscous_ = jointVector(p.plate_damping_Nms, p.link_damping_Ns_per_m, p.rotor_damping_Nms);
  coulomb_ = jointVector(p.plate_coulomb_Nm, p.link_coulomb_N, p.rotor_coulomb_Nm);
  moveTo(settings.X_DH_start);
}

void DualArmPlant::moveTo(const Pose& X_DH) noexcept {
  const DualArmParameters& p = settings_.arms;
  X_DH_ = X_DH;
  V_DH_ = {};
  link_rate_.setZero();
  motor_rate_.setZero();
  JointVector carry;
  if (handleMotion(p, X_DH_, motion_) != Status::Ok) motion_ = {};
  if (motorEfforts(p, X_DH_, -handleWeight(p), carry) != Status::Ok) carry.setZero();
  motor_ = motion_.joints;
  if (!settings_.is_rigid && motion_.joints[2] > 0)
    motor_ += carry.cwiseQuotient(structureStiffness(p, motion_.joints));
  commands_.fill(carry);
  efforts_ = carry;
  command_s_ = time_s_;
  M_handle_ = handleInertia();
}

DualArmReading DualArmPlant::read() noexcept {
  const DualArmParameters& p = settings_.arms;
  DualArmReading reading;
  reading.time_s = time_s_;
  JointVector values = motor_;
  if (settings_.has_quantised_encoders) {
    const JointVector step = jointVector(p.plate_step_rad, p.link_step_m, p.rotor_step_rad);
    for (int i = 0; i < 7; ++i)
      values[i] = rounded(values[i] + p.noise_steps * step[i] * random_.normal(), step[i]);
  }
  reading.joints = fromVector(values);
  return reading;
}

void DualArmPlant::drive(const JointVector& efforts) noexcept {
  const JointVector peak = motorLimits(settings_.arms, 1);
  std::rotate(commands_.begin(), commands_.end() - 1, commands_.end());
  for (int i = 0; i < 7; ++i)
    commands_[0][i] = std::isfinite(efforts[i]) ? std::clamp(efforts[i], -peak[i], peak[i]) : 0;
  command_s_ = time_s_;
  efforts_ = commands_[std::min(static_cast<std::size_t>(settings_.arms.delay_ticks), kMaxDelay - 1)];
}

DualArmPlant::Mat6 DualArmPlant::handleInertia() const noexcept {
  const DualArmParameters& p = settings_.arms;
  Mat6 M = Mat6::Zero();
  M.topLeftCorner<3, 3>() = X_DH_.R * p.handle_kgm2.asDiagonal() * X_DH_.R.transpose();
  M.bottomRightCorner<3, 3>().diagonal().array() = p.handle_kg;
  return M;
}

DualArmPlant::Motors DualArmPlant::motorsOf(double dt_s) const noexcept {
  const DualArmParameters& p = settings_.arms;
  Motors m{settings_.is_rigid, dt_s, motor_inertia_, dt_s * efforts_, {}, {}, {}};
  if (m.is_rigid) return m;
  const JointVector K = structureStiffness(p, motion_.joints), e = stretchOf(motor_, motion_.joints);
  m.g = (dt_s * p.structure_damping_s + dt_s * dt_s) * K;
  m.alone = m.inertia.cwiseProduct(motor_rate_) + m.drive - dt_s * K.cwiseProduct(e);
  m.pull = dt_s * (K.cwiseProduct(e) + structureDrift(p, motion_.joints, e));
  return m;
}

// Stops only push: a stop whose damper would pull is left out. Returns the energy stored in the stops.
double DualArmPlant::addStops(double dt_s, const Vec6& V_next, Mat6& A, Vec6& b) const noexcept {
  const DualArmParameters& p = settings_.arms;
  double stored_J = 0;
  for (int i = 0; i < kStoppedAxes; ++i) {
    const auto [least, most, is_slide] = axisRange(p, i);
    const bool is_gimbal = i >= 6;
    const double value = axisValue(motion_.joints, motion_.q2_rad, i);
    const double beyond = value > most ? value - most : value < least ? value - least : 0;
    if (beyond == 0) continue;
    const double k = is_slide    ? p.link_stop_N_per_m
                     : is_gimbal ? p.gimbal_stop_Nm_per_rad
                                 : p.plate_stop_Nm_per_rad;
    stored_J += 0.5 * k * beyond * beyond;
    const Row6 row = i < 7 ? Row6(motion_.J.row(i)) : motion_.J_q2;
    const double damper = dt_s * k * (dt_s + p.stop_damping_s);
    const double push = dt_s * k * beyond + damper * row.dot(V_next);
    if (push * beyond <= 0) continue;
    A += damper * row.transpose() * row;
    b -= dt_s * k * beyond * row.transpose();
  }
  return stored_J;
}

// Solves (M + dt (B + friction) + dt^2 K) V' = momentum + dt F. The state is momentum (of the joints in joint
// space, of the handle in D), so that the change of inertia with the pose needs no term of its own. Dry
// friction is a damper f_c / max(|q'|, slip), found by a few iterations on q'.
DualArmPlant::Vec6 DualArmPlant::solve(double dt_s, const HandForce& hand, const Motors& motors,
                                       JointVector& damper, double& stops_J) const noexcept {
  const JointMatrix& J = motion_.J;
  Mat6 M_hand = Mat6::Zero(), hand_side = Mat6::Zero();
  M_hand.topLeftCorner<3, 3>().diagonal().array() = hand.inertia_kgm2;
  M_hand.bottomRightCorner<3, 3>().diagonal().array() = hand.mass_kg;
  hand_side.topLeftCorner<3, 3>() = hand.b_Nms_per_rad + dt_s * hand.k_Nm_per_rad;
  hand_side.bottomRightCorner<3, 3>() = hand.b_Ns_per_m + dt_s * hand.k_N_per_m;
  // The load is the weight, and the hand's spring and damper at rest in the present pose.
  const Vec6 V = stacked(V_DH_.w, V_DH_.v);
  const Vec6 F = stacked(handleWeight(settings_.arms)) + stacked(handWrench(hand, X_DH_, Twist{}));
  const Vec6 momentum = (M_handle_ + M_hand) * V + J.transpose() * link_inertia_.cwiseProduct(link_rate_);
  const JointVector slip = jointVector(kPlateSlip_rad_s, kLinkSlip_m_s, kRotorSlip_rad_s);
  const Mat6 fixed = handleInertia() + M_hand + dt_s * hand_side;

  Vec6 V_next = V;
  JointVector rate = motor_rate_;
  for (int i = 0; i < kIterations; ++i) {
    damper = viscous_ + coulomb_.cwiseQuotient(rate.cwiseAbs().cwiseMax(slip));
    Mat6 A = fixed + J.transpose() * (link_inertia_ + motors.resistance(damper)).asDiagonal() * J;
    Vec6 b = momentum + dt_s * F + J.transpose() * motors.impulse(damper);
    stops_J = addStops(dt_s, V_next, A, b);
    V_next = A.llt().solve(b);
    rate = motors.rate(J * V_next, damper);
  }
  return V_next;
}

void DualArmPlant::move(double dt_s, const Vec6& V_next, const Motors& motors,
                        const JointVector& damper) noexcept {
  const DualArmParameters& p = settings_.arms;
  M_handle_ = handleInertia();
  link_rate_ = motion_.J * V_next;
  motor_rate_ = motors.rate(link_rate_, damper);
  kinetic_J_ = 0.5 * V_next.dot(M_handle_ * V_next) + 0.5 * link_rate_.cwiseAbs2().dot(link_inertia_) +
               0.5 * motor_rate_.cwiseAbs2().dot(motor_inertia_);
  friction_J_ += dt_s * motor_rate_.cwiseAbs2().dot(damper);

  V_DH_ = {V_next.head<3>(), V_next.tail<3>()};
  X_DH_ = Pose(Quat(rotationFromVector(dt_s * V_DH_.w) * X_DH_.R), Vec3(X_DH_.p + dt_s * V_DH_.v));
  time_s_ += dt_s;
  // At a singularity the last valid Jacobian stays in use.
  if (handleMotion(p, X_DH_, motion_) != Status::Ok) motion_.joints += dt_s * link_rate_;
  if (settings_.is_rigid) {
    motor_ = motion_.joints;
    return;
  }
  motor_ += dt_s * motor_rate_;
  const JointVector K = structureStiffness(p, motion_.joints), e = stretchOf(motor_, motion_.joints);
  friction_J_ += dt_s * p.structure_damping_s * (motor_rate_ - link_rate_).cwiseAbs2().dot(K);
  structure_J_ = 0.5 * e.cwiseAbs2().dot(K);
}

void DualArmPlant::step(double dt_s, const HandForce& hand) noexcept {
  if (!(dt_s > 0)) return;
  if (time_s_ - command_s_ > settings_.arms.watchdog_s) {  // the amplifiers' own watchdog
    commands_.fill(JointVector::Zero());
    efforts_.setZero();
  }
  const Motors motors = motorsOf(dt_s);
  JointVector damper;
  double stops_J = 0;
  const Vec6 V_next = solve(dt_s, hand, motors, damper, stops_J);
  if (!V_next.allFinite()) return;  // a hand force that is not finite has no effect

  const Twist V_before = V_DH_;
  heat_.add(efforts_, dt_s);
  structure_J_ = 0;
  move(dt_s, V_next, motors, damper);
  structure_J_ += stops_J;
  kinetic_J_ += 0.5 * hand.mass_kg * V_DH_.v.squaredNorm() + 0.5 * hand.inertia_kgm2 * V_DH_.w.squaredNorm();
  F_hand_ = handWrench(hand, X_DH_, V_DH_);
  F_hand_.f -= hand.mass_kg / dt_s * (V_DH_.v - V_before.v);
  F_hand_.tau -= hand.inertia_kgm2 / dt_s * (V_DH_.w - V_before.w);
}

}  // namespace vps::device
