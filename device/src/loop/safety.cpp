// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/safety.h"

#include <algorithm>
#include <cmath>

namespace vps::device {
namespace {

// Factor of at most 1 that brings force and torque within their limits. Dividing first avoids overflow for
// huge values.
double scaleWithin(const Wrench& F, double force_N, double torque_Nm) {
  const double f = F.f.stableNorm(), tau = F.tau.stableNorm();
  double scale = 1;
  if (f > force_N) scale = std::min(scale, force_N / f);
  if (tau > torque_Nm) scale = std::min(scale, torque_Nm / tau);
  return scale;
}

bool isRotation(const Mat3& R) {
  return (R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-6;
}

}  // namespace

const char* toText(SafetyFault fault) noexcept {
  switch (fault) {
    case SafetyFault::None:
      return "none";
    case SafetyFault::BadWrench:
      return "wrench not finite";
    case SafetyFault::BadPose:
      return "pose not finite";
    case SafetyFault::Jump:
      return "pose jumped";
    case SafetyFault::DeviceLost:
      return "device lost";
    case SafetyFault::ClockBackwards:
      return "device's clock went backwards";
    case SafetyFault::BadGains:
      return "coupling gains out of range";
    case SafetyFault::PhysicsStalled:
      return "physics stalled";
  }
  return "unknown";
}

DeviceEventKind eventOf(SafetyFault fault) noexcept {
  switch (fault) {
    case SafetyFault::BadPose:
      return DeviceEventKind::BadPose;
    case SafetyFault::Jump:
      return DeviceEventKind::PoseJump;
    case SafetyFault::DeviceLost:
      return DeviceEventKind::DeviceLost;
    case SafetyFault::ClockBackwards:
      return DeviceEventKind::ClockBackwards;
    case SafetyFault::BadGains:
      return DeviceEventKind::BadGains;
    case SafetyFault::PhysicsStalled:
      return DeviceEventKind::PhysicsStalled;
    case SafetyFault::None:
    case SafetyFault::BadWrench:
      break;
  }
  return DeviceEventKind::BadForce;
}

void SafetyGuard::trip(SafetyFault fault) noexcept {
  if (state_.fault == SafetyFault::None) {
    state_.fault = fault;
    ++state_.faults;
  }
  last_ = {};
}

Wrench SafetyGuard::guard(const DeviceSample& sample, const Wrench& wanted, double dt_s) noexcept {
  if (sample.status != Status::Ok) {
    trip(SafetyFault::DeviceLost);
  } else if (!sample.X_DH.isFinite() || !sample.V_DH.isFinite() || !isRotation(sample.X_DH.R) ||
             !std::isfinite(sample.time_s)) {
    trip(SafetyFault::BadPose);
  } else if (has_pose_ && sample.time_s < time_last_s_) {
    trip(SafetyFault::ClockBackwards);
  } else if (has_pose_ && ((sample.X_DH.p - X_last_.p).norm() > limits_.jump_m ||
                           rotationVector(sample.X_DH.R * X_last_.R.transpose()).norm() > limits_.jump_rad)) {
    trip(SafetyFault::Jump);
  } else if (!wanted.isFinite() || !(dt_s > 0)) {
    trip(SafetyFault::BadWrench);
  }
  if (state_.fault != SafetyFault::None) return {};
  X_last_ = sample.X_DH;
  time_last_s_ = sample.time_s;
  has_pose_ = true;

  const double scale = scaleWithin(wanted, limits_.force_N, limits_.torque_Nm);
  if (scale < 1) ++state_.limited;
  ramp_ = std::min(1.0, ramp_ + dt_s / limits_.rearm_s);
  const Wrench F = wanted * (scale * ramp_);

  // last_ and F are within the limits, which are convex, and so is every wrench between both.
  const Wrench change = F + -last_;
  const double share = scaleWithin(change, limits_.slew_N_per_s * dt_s, limits_.slew_Nm_per_s * dt_s);
  if (share < 1) ++state_.slewed;
  last_ += change * share;
  return last_;
}

void SafetyGuard::rearm() noexcept {
  if (state_.fault == SafetyFault::None) return;
  state_.fault = SafetyFault::None;
  has_pose_ = false;
  ramp_ = 0;
  last_ = {};
}

}  // namespace vps::device
