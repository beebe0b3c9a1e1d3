// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/dual_arm/controller.h"

#include <algorithm>
#include <cmath>

#include "vps_device/dual_arm/statics.h"

namespace vps::device {
namespace {

using Kind = DeviceEventKind;

constexpr double kHot = 0.8;            // share of the allowed heat: warns before the peak decreases at 0.9
constexpr double kNearStop_rad = 0.03;  // plates, q2, q3: 2 deg
constexpr double kNearStop_m = 0.02;    // slides
constexpr double kArmsNear_m = 0.02;    // between the arms' surfaces
// q2: 21 deg before the singularity; the motor needs 3 times the torque
constexpr double kNearSingular_rad = 1.2;

bool isTwistWithin(const Twist& V, double v_m_s, double w_rad_s) {
  return V.v.norm() <= v_m_s && V.w.norm() <= w_rad_s;
}

Vec3 gimbalCentre(const DualArmParameters& p, Side side, const ArmJoints& joints) {
  return armBase(p, side) * armPosition(joints);
}

}  // namespace

DualArmController::DualArmController(DualArmHardware& hardware, const DualArmControllerSettings& settings,
                                     DeviceEventQueue* events)
    : settings_(settings),
      hardware_(&hardware),
      events_(events),
      limits_(dualArmLimits(settings.arms, settings.rate_hz, settings.has_quantised_encoders)),
      heat_(settings.arms),
      is_calibrated_(!settings.needs_calibration) {
  if (!is_calibrated_) trip(Kind::NotCalibrated, 0);
}

void DualArmController::trip(Kind kind, double value) noexcept {
  if (has_fault_) return;  // the first fault is the cause
  has_fault_ = true;
  fault_ = kind;
  if (events_ != nullptr) events_->push({last_.time_s, kind, value});
}

void DualArmController::warn(Kind kind, bool is_so, double value) noexcept {
  const unsigned bit = 1u << static_cast<unsigned>(kind);
  const bool is_new = is_so && (warned_ & bit) == 0;
  warned_ = is_so ? warned_ | bit : warned_ & ~bit;
  if (is_new && events_ != nullptr) events_->push({last_.time_s, kind, value});
}

// --- Encoders -> pose

bool DualArmController::isSane(const DualArmReading& reading) noexcept {
  if (!reading.has_left)
    trip(Kind::LeftArmLost, 0);
  else if (!reading.has_right)
    trip(Kind::RightArmLost, 0);
  else if (!toVector(reading.joints).allFinite() || !std::isfinite(reading.time_s))
    trip(Kind::BadEncoder, 0);
  else if (has_time_ && reading.time_s < last_.time_s)
    trip(Kind::ClockBackwards, last_.time_s - reading.time_s);
  else
    return true;
  return false;
}

// Checks that no gimbal centre has jumped, and that the distance between both centres is the handle's length.
bool DualArmController::isWhole(const JointVector& values, double dt_s) noexcept {
  const DualArmParameters& p = settings_.arms;
  const DualArmJoints now = fromVector(values), before = fromVector(joints_);
  const Vec3 p_L = gimbalCentre(p, Side::Left, now.left), p_R = gimbalCentre(p, Side::Right, now.right);
  if (has_read_) {
    const double jump_m = std::max((p_L - gimbalCentre(p, Side::Left, before.left)).norm(),
                                   (p_R - gimbalCentre(p, Side::Right, before.right)).norm());
    if (!(jump_m <= p.jump_m * std::max(1.0, dt_s * settings_.rate_hz))) {
      trip(Kind::EncoderJump, jump_m);
      return false;
    }
  }
  const double apart_m = (p_R - p_L).norm() - p.handle_m;
  if (std::abs(apart_m) <= p.apart_m) return true;
  trip(Kind::PulledApart, apart_m);
  return false;
}

// The structure bends under the weight that the motors carry; the known deflection is subtracted.
Status DualArmController::poseOf(const JointVector& joints, Pose& X_DH) const noexcept {
  const DualArmParameters& p = settings_.arms;
  Pose X_bent;
  const Status status = handlePose(p, fromVector(joints), X_bent);
  if (status != Status::Ok) return status;
  JointVector carry = JointVector::Zero();
  if (!settings_.is_rigid && motorEfforts(p, X_bent, -handleWeight(p), carry) != Status::Ok)
    return Status::Singular;
  return handlePose(p, fromVector(joints - carry.cwiseQuotient(structureStiffness(p, joints))), X_DH);
}

void DualArmController::follow(const Pose& X_DH, double dt_s) noexcept {
  if (has_read_) {
    // Gain of a first-order filter, divided by dt.
    const double gain = 1 / (settings_.arms.velocity_filter_s + dt_s);
    last_.V_DH.v += gain * (X_DH.p - last_.X_DH.p - dt_s * last_.V_DH.v);
    last_.V_DH.w += gain * (rotationVector(X_DH.R * last_.X_DH.R.transpose()) - dt_s * last_.V_DH.w);
  }
  last_.X_DH = X_DH;
  if (!isTwistWithin(last_.V_DH, settings_.arms.speed_m_s, settings_.arms.turn_rad_s))
    trip(Kind::SharpMotion, std::max(last_.V_DH.v.norm(), last_.V_DH.w.norm()));
}

void DualArmController::watchJoints(const JointVector& joints) noexcept {
  const DualArmParameters& p = settings_.arms;
  HandleMotion motion;
  if (handleMotion(p, last_.X_DH, motion) != Status::Ok) return;
  int nearest = -1;
  for (int i = 0; i < kStoppedAxes; ++i) {
    const auto [least, most, is_slide] = axisRange(p, i);
    const double value = axisValue(joints, motion.q2_rad, i);
    const double near = is_slide ? kNearStop_m : kNearStop_rad;
    if (value > most - near || value < least + near) nearest = i;
  }
  warn(Kind::NearStop, nearest >= 0, nearest);
  const double clearance_m = armClearance_m(p, fromVector(joints));
  warn(Kind::ArmsNear, clearance_m < kArmsNear_m, clearance_m);
  warn(Kind::NearSingular, std::abs(motion.q2_rad) > kNearSingular_rad, motion.q2_rad);
}

DeviceSample DualArmController::read() noexcept {
  const DualArmReading reading = hardware_->read();
  const double period_s = 1 / settings_.rate_hz;
  if (isSane(reading)) {
    const double dt_s = has_time_ ? reading.time_s - last_.time_s : period_s;
    const bool is_new = !has_time_ || dt_s > 0;
    silent_s_ = is_new ? 0 : silent_s_ + period_s;
    if (silent_s_ > settings_.arms.watchdog_s) trip(Kind::Silent, silent_s_);
    if (is_new) {
      heat_.add(efforts_, dt_s);
      unwritten_s_ += dt_s;
      if (has_written_ && unwritten_s_ > settings_.arms.watchdog_s) trip(Kind::PeerLost, unwritten_s_);
      last_.time_s = reading.time_s;
      has_time_ = true;
      const JointVector joints = toVector(reading.joints) + offset_;
      Pose X_DH;
      last_.status = has_fault_ || !isWhole(joints, dt_s) ? Status::Fault : poseOf(joints, X_DH);
      if (last_.status == Status::Ok) {
        follow(X_DH, dt_s);
        joints_ = joints;
        has_read_ = true;
        watchJoints(joints);
      }
    }
  }
  if (has_fault_) {
    last_.status = Status::Fault;
    last_.V_DH = {};
  }
  return last_;
}

// --- Wrench -> motors

void DualArmController::write(const Wrench& F_Ho_D) noexcept {
  const DualArmParameters& p = settings_.arms;
  unwritten_s_ = 0;
  has_written_ = true;
  warn(Kind::BadWrench, !F_Ho_D.isFinite(), 0);
  warn(Kind::MotorHot, heat_.heat().maxCoeff() > kHot, heat_.heat().maxCoeff());
  efforts_.setZero();
  const bool is_free = has_fault_ && fault_ != Kind::PeerLost;
  JointVector bias, wish;
  if (!is_free && has_read_ && motorEfforts(p, last_.X_DH, -handleWeight(p), bias) == Status::Ok) {
    // The handle's weight comes first; the remaining effort is for the hand.
    const Wrench wanted = F_Ho_D.isFinite() && last_.status == Status::Ok ? F_Ho_D : Wrench{};
    const JointVector limit = heat_.limits();
    double scale =
        motorEfforts(p, last_.X_DH, wanted, wish) == Status::Ok ? saturationScale(bias, wish, limit) : 0;
    const double share = heat_.peakShare();
    const double force_N = p.force_N + share * (p.force_peak_N - p.force_N);
    const double torque_Nm = p.torque_Nm + share * (p.torque_peak_Nm - p.torque_Nm);
    scale = std::min(scale, force_N / std::max(force_N, wanted.f.stableNorm()));
    scale = std::min(scale, torque_Nm / std::max(torque_Nm, wanted.tau.stableNorm()));
    if (scale < 1) ++saturated_;
    warn(Kind::Saturated, scale < 1, scale);
    efforts_ = (bias + scale * wish).cwiseMin(limit).cwiseMax(-limit);
    if (!efforts_.allFinite()) efforts_.setZero();  // huge wrenches may overflow in the joint efforts
  }
  hardware_->drive(efforts_);
}

void DualArmController::rearm() noexcept {
  forgetMotion();
  silent_s_ = unwritten_s_ = 0;
  has_written_ = false;
  has_time_ = false;
  if (!has_fault_) return;
  has_fault_ = false;
  if (events_ != nullptr) events_->push({last_.time_s, Kind::Rearmed, 0});
  if (!is_calibrated_) trip(Kind::NotCalibrated, 0);
}

void DualArmController::forgetMotion() noexcept {
  has_read_ = false;
  last_.V_DH = {};
}

Status DualArmController::calibrate(const Pose& X_DH, int readings) noexcept {
  DualArmJoints joints;
  const Status status = handleJoints(settings_.arms, X_DH, joints);
  if (status != Status::Ok) return status;
  JointVector sum = JointVector::Zero();
  for (int i = 0; i < readings; ++i) {
    const DualArmReading reading = hardware_->read();
    if (!reading.has_left || !reading.has_right || !toVector(reading.joints).allFinite())
      return Status::Fault;
    sum += toVector(reading.joints) / readings;
  }
  offset_ = toVector(joints) - sum;
  is_calibrated_ = true;
  if (events_ != nullptr) events_->push({last_.time_s, Kind::Calibrated, 0});
  if (has_fault_ && fault_ == Kind::NotCalibrated) rearm();
  forgetMotion();
  return Status::Ok;
}

}  // namespace vps::device
