// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/loop.h"

#include <algorithm>
#include <cmath>

#include "vps_device/gains.h"

namespace vps::device {

HapticLoop::HapticLoop(Device& device, CouplingPort& port, const LoopSettings& settings)
    : device_(&device), port_(&port), settings_(settings), limits_(device.limits()), guard_(settings.safety) {
  delay_ticks_ = std::clamp(limits_.delay_s / settings_.period_s, 0.0, static_cast<double>(kMaxDelay));
  setGains(settings_.gains);
}

void HapticLoop::setGains(const CouplingGains& gains) noexcept {
  settings_.gains = gains;
  const double turn = settings_.map.force_scale,
               line = turn * settings_.map.scale;  // scene stiffness at the device
  const double half_s = 0.5 * settings_.period_s;
  spare_Ns_per_m_ =
      std::max(0.0, limits_.damping_Ns_per_m - line * (gains.k_N_per_m * half_s + gains.b_Ns_per_m));
  spare_Nms_per_rad_ =
      std::max(0.0, limits_.damping_Nms_per_rad - turn * (gains.k_Nm_per_rad * half_s + gains.b_Nms_per_rad));
  if (!areUsable(gains)) latchFault(SafetyFault::BadGains);
}

void HapticLoop::grasp(const Pose& X_WG) noexcept {
  const DeviceSample sample = device_->read();
  if (sample.status != Status::Ok || !X_WG.isFinite()) return;
  const Pose X_WH = settings_.map.toScene(sample.X_DH);
  grasp_ = Grasp::between(X_WH, X_WG);
  report_.X_WG = X_WG;
  if (settings_.is_collocated) {
    grasp_.offset_W = Vec3::Zero();
    report_.X_WG = grasp_.toGrasp(X_WH);
  }
  is_holding_ = true;
  clutch_.closeAtOnce();
}

void HapticLoop::handOver(const Pose& X_WG) noexcept {
  grasp(X_WG);
  if (settings_.is_collocated) return;  // while a clutch closes, the proxy would not follow the hand exactly
  clutch_.openAtOnce();
  clutch_.close();
}

void HapticLoop::release() noexcept {
  is_holding_ = false;
}

void HapticLoop::rearm() noexcept {
  const bool was_faulted = guard_.state().fault != SafetyFault::None;
  device_->rearm();
  guard_.rearm();
  if (was_faulted && settings_.events != nullptr)
    settings_.events->push({report_.time_s, DeviceEventKind::Rearmed, 0});
  if (!areUsable(settings_.gains)) latchFault(SafetyFault::BadGains);
  has_before_ = false;
  const CouplingState& part = received_.part;
  if (is_holding_ && part.X_W.isFinite()) grasp(part.X_W);
}

void HapticLoop::latchFault(SafetyFault fault) noexcept {
  guard_.latchFault(fault);
  reportFault();
}

void HapticLoop::reportFault() noexcept {
  const SafetyState& state = guard_.state();
  if (state.faults == reported_faults_) return;
  reported_faults_ = state.faults;
  if (settings_.events != nullptr)
    settings_.events->push({report_.time_s, eventOf(state.fault), snapshot_age_s_});
}

// The age is counted in ticks, since physics and the device need not share a clock. A time stamp that is not
// a number does not count as new.
void HapticLoop::watchPhysics(double dt_s) noexcept {
  const CouplingState& part = received_.part;
  const bool is_new = part.time_s < snapshot_time_s_ || part.time_s > snapshot_time_s_;
  if (is_new) snapshot_time_s_ = part.time_s;
  snapshot_age_s_ = is_new ? 0 : snapshot_age_s_ + dt_s;
  if (settings_.physics_limit_s > 0 && is_holding_ && part.is_coupled &&
      snapshot_age_s_ > settings_.physics_limit_s)
    latchFault(SafetyFault::PhysicsStalled);
}

void HapticLoop::receivePart() noexcept {
  const std::int32_t step_before = received_.step;
  if (port_->remote != nullptr)
    port_->remote->receive(received_);
  else
    received_ = port_->physics.read();
  if (received_.step != step_before && received_.stored_J)
    balance(workAt_J(received_.part.time_s), *received_.stored_J, 0);
}

const TickReport& HapticLoop::tick(double dt_s) noexcept {
  receivePart();
  return tickWithReceivedPart(dt_s);
}

const TickReport& HapticLoop::tickWithReceivedPart(double elapsed_s) noexcept {
  const double period_s = settings_.period_s;
  const double dt_s = elapsed_s > period_s ? std::min(elapsed_s, 4 * period_s) : period_s;
  watchPhysics(dt_s);
  const DeviceSample sample = device_->read();
  const bool is_good = sample.status == Status::Ok && sample.X_DH.isFinite() && sample.V_DH.isFinite();
  CouplingState proxy{report_.X_WG, Twist{}, sample.time_s, is_holding_};
  Wrench wanted_D;
  if (is_good) {
    const Twist step_D = stepSince(sample);
    accountEnergy(sample, step_D);
    moveProxy(step_D, sample.X_DH);
    const double share = clutch_.ratio();
    proxy.X_W = toGrasp(sample.X_DH);
    const Twist V_W = settings_.map.toScene(sample.V_DH);
    proxy.V_W = {share * V_W.w, share * V_W.v};
    wanted_D = settings_.map.toDevice(-coupling(proxy, dt_s)) * share + passivityDamping(sample.V_DH);
  }
  report_.F_hand_D = guard_.guard(sample, wanted_D, dt_s);
  device_->write(report_.F_hand_D);
  std::rotate(F_written_D_.begin(), F_written_D_.end() - 1, F_written_D_.end());
  F_written_D_[0] = report_.F_hand_D;

  // While safety holds the force at zero the proxy stands still, so that the part does not follow a pose that
  // cannot be trusted.
  const bool is_faulted = guard_.state().fault != SafetyFault::None;
  if (is_faulted) {
    proxy.X_W = report_.X_WG;
    proxy.V_W = {};
  }
  report_.time_s = sample.time_s;
  keepWork(sample.time_s);
  reportFault();
  report_.status = is_faulted ? Status::Fault : sample.status;
  report_.X_WG = proxy.X_W;
  report_.V_WG = proxy.V_W;
  report_.clutch_ratio = clutch_.ratio();
  report_.F_hand_W = rotated(settings_.map.X_WD.R, report_.F_hand_D);
  ++ticks_;
  ++counts_[std::min(static_cast<std::size_t>(report_.status), kStatusCount - 1)];
  const HapticState now = state();
  port_->haptic.write(now);
  if (port_->remote != nullptr) port_->remote->send(now);
  return report_;
}

HapticState HapticLoop::state() const noexcept {
  return {{report_.X_WG, report_.V_WG, report_.time_s, is_holding_},
          static_cast<std::int32_t>(ticks_),
          report_,
          guard_.state(),
          passivity_};
}

Wrench HapticLoop::coupling(const CouplingState& proxy, double dt_s) noexcept {
  const CouplingState& part = received_.part;
  if (!is_holding_ || !part.is_coupled) return {};
  if (settings_.local != nullptr)
    return couplingWrench(settings_.gains, proxy,
                          settings_.local->follow(settings_.gains, proxy, part, dt_s));
  if (!settings_.extrapolates_part) return couplingWrench(settings_.gains, proxy, part);
  const double age_s = std::clamp(proxy.time_s - part.time_s, 0.0, settings_.hold_limit_s);
  CouplingState ahead = part;
  ahead.X_W.p += age_s * part.V_W.v;
  ahead.X_W.R = rotationFromVector(age_s * part.V_W.w) * part.X_W.R;
  return couplingWrench(settings_.gains, proxy, ahead);
}

Wrench HapticLoop::passivityDamping(const Twist& V_DH) const noexcept {
  const bool is_active = settings_.has_passivity_controller && has_stored_;
  if (!is_active || passivity_.rise_J() <= settings_.injected_bound_J) return {};
  return {-spare_Nms_per_rad_ * V_DH.w, -spare_Ns_per_m_ * V_DH.v};
}

// The mean wrench over the period that ends now. If the delay is not a whole number of periods, two
// successive wrenches act within one period, and are averaged by their shares.
Wrench HapticLoop::actingWrench() const noexcept {
  const auto whole = static_cast<std::size_t>(delay_ticks_);
  const double late = delay_ticks_ - static_cast<double>(whole);
  return F_written_D_[whole] * (1 - late) + F_written_D_[whole + 1] * late;
}

Twist HapticLoop::stepSince(const DeviceSample& sample) const noexcept {
  if (!has_before_) return {};
  return {rotationVector(sample.X_DH.R * X_DH_before_.R.transpose()), Vec3(sample.X_DH.p - X_DH_before_.p)};
}

// The displacement was made under the force of the last tick, so the clutch ratio of that tick applies.
void HapticLoop::moveProxy(const Twist& step_D, const Pose& X_DH) noexcept {
  if (is_holding_ && !clutch_.isClosed()) {
    const Pose X_WG = clutch_.follow(report_.X_WG, settings_.map.toScene(step_D));
    grasp_ = Grasp::between(settings_.map.toScene(X_DH), X_WG);
  }
  clutch_.advance(settings_.period_s, settings_.clutch_s);
}

void HapticLoop::accountEnergy(const DeviceSample& sample, const Twist& step) noexcept {
  const bool had_before = has_before_;
  X_DH_before_ = sample.X_DH;
  has_before_ = true;
  if (!had_before) return;
  const Wrench F_acting_D = actingWrench();
  accountQuantisation(F_acting_D);
  const double work_J = power(F_acting_D, step);
  (work_J > 0 ? passivity_.to_hand_J : passivity_.from_hand_J) += std::abs(work_J);

  // One encoder step per tick is not a real velocity: use the lower of the raw and the filtered estimate.
  const double dt_s = settings_.period_s;
  const double v = std::min(step.v.norm() / dt_s, sample.V_DH.v.norm());
  const double w = std::min(step.w.norm() / dt_s, sample.V_DH.w.norm());
  passivity_.dissipated_J += dt_s * (limits_.damping_Ns_per_m * v * v + limits_.damping_Nms_per_rad * w * w);

  // In scene joules: scene wrench times scene displacement.
  net_scene_J_ += power(settings_.map.toScene(F_acting_D), settings_.map.toScene(step));
}

void HapticLoop::accountQuantisation(const Wrench& F_D) noexcept {
  force_variation_N_ += (F_D.f - F_accounted_D_.f).norm();
  torque_variation_Nm_ += (F_D.tau - F_accounted_D_.tau).norm();
  F_accounted_D_ = F_D;
  const double line_J = limits_.resolution_m * (force_variation_N_ + F_D.f.norm()),
               turn_J = limits_.resolution_rad * (torque_variation_Nm_ + F_D.tau.norm());
  passivity_.quantisation_error_bound_J = (settings_.map.scale * line_J + turn_J) / settings_.map.force_scale;
}

// Device dissipation is converted to scene joules by the scale of the translation that it brakes.
void HapticLoop::keepWork(double time_s) noexcept {
  const double dissipated_J = passivity_.dissipated_J * settings_.map.scale / settings_.map.force_scale;
  works_[ticks_ % works_.size()] = {time_s, net_scene_J_ - dissipated_J};
}

// Work until the tick with this sample time; until the last tick if no stored tick has that time.
double HapticLoop::workAt_J(double time_s) const noexcept {
  const std::uint64_t kept = std::min<std::uint64_t>(ticks_, works_.size());
  for (std::uint64_t age = 1; age <= kept; ++age) {
    const Work& work = works_[(ticks_ - age) % works_.size()];
    if (work.time_s == time_s) return work.scene_J;
    if (work.time_s < time_s) break;
  }
  return kept == 0 ? 0 : works_[(ticks_ - 1) % works_.size()].scene_J;
}

void HapticLoop::observeStoredEnergy(double stored_J, double actuator_J) noexcept {
  balance(workAt_J(report_.time_s), stored_J, actuator_J);
}

void HapticLoop::balance(double work_J, double stored_J, double actuator_J) noexcept {
  const double balance_J = work_J + stored_J - actuator_J;
  if (!has_stored_) balance_start_J_ = balance_J;
  has_stored_ = true;
  passivity_.balance_J = balance_J - balance_start_J_;
  passivity_.least_J = std::min(passivity_.least_J, passivity_.balance_J);
  passivity_.injected_J = std::max(passivity_.injected_J, passivity_.rise_J());
}

std::uint64_t HapticLoop::count(Status status) const noexcept {
  return counts_[std::min(static_cast<std::size_t>(status), kStatusCount - 1)];
}

Pose HapticLoop::toGrasp(const Pose& X_DH) const noexcept {
  const Pose X_WH = settings_.map.toScene(X_DH);
  return is_holding_ ? grasp_.toGrasp(X_WH) : X_WH;
}

HandForce HapticLoop::toDevice(const HandForce& hand_W) const noexcept {
  const Mat3 R_DW = settings_.map.X_WD.R.transpose();
  const auto turned = [&R_DW](const Mat3& m) { return Mat3(R_DW * m * R_DW.transpose()); };
  HandForce hand = hand_W;
  hand.X_eq = settings_.map.toDevice(is_holding_ ? grasp_.toHandle(hand_W.X_eq) : hand_W.X_eq);
  hand.V_eq = settings_.map.toDevice(hand_W.V_eq);
  hand.k_N_per_m = turned(hand_W.k_N_per_m);
  hand.b_Ns_per_m = turned(hand_W.b_Ns_per_m);
  hand.k_Nm_per_rad = turned(hand_W.k_Nm_per_rad);
  hand.b_Nms_per_rad = turned(hand_W.b_Nms_per_rad);
  hand.F = settings_.map.toDevice(hand_W.F);
  return hand;
}

}  // namespace vps::device
