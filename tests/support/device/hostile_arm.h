// SPDX-License-Identifier: BSD-3-Clause
// A dual arm whose hardware gives wrong readings, stops answering and fails, in a sequence given by bytes,
// and a check of the properties that must always hold. A test with a fixed seed and a fuzz program use it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "vps_device/dual_arm/controller.h"
#include "vps_device/dual_arm/plant.h"
#include "vps_device/gains.h"
#include "vps_device/loop.h"

namespace vps_test {

using Require = void (*)(bool claim, const char* promise);

/// A firm hand around the identity pose. @param k, b  stiffness and damping of translation [N/m, N s/m]
inline vps::device::HandForce firmHand(double k, double b) {
  vps::device::HandForce hand;
  hand.k_N_per_m = k * vps::Mat3::Identity();
  hand.b_Ns_per_m = b * vps::Mat3::Identity();
  hand.k_Nm_per_rad = 5 * vps::Mat3::Identity();
  hand.b_Nms_per_rad = 0.2 * vps::Mat3::Identity();
  hand.mass_kg = 1;
  hand.inertia_kgm2 = 3e-3;
  return hand;
}

/// The simulated arm, with a fault between it and the controller.
class HostileArm final : public vps::device::DualArmHardware {
 public:
  enum Trouble {
    kNone,
    kNan,
    kHuge,
    kJump,
    kApart,
    kLeftLost,
    kRightLost,
    kClockBack,
    kClockNan,
    kSilent,
    kDrift
  };
  static constexpr int kTroubles = 11;

  HostileArm(vps::device::DualArmPlant& plant, Require require) : plant_(plant), require_(require) {}

  void set(Trouble trouble, unsigned detail) {
    trouble_ = trouble;
    detail_ = detail;
    if (trouble != kNone && trouble != kLeftLost && trouble != kRightLost && trouble != kSilent)
      has_lied_ = true;
  }
  [[nodiscard]] bool hasLied() const { return has_lied_; }

  vps::device::DualArmReading read() noexcept override {
    vps::device::DualArmReading reading = plant_.read();
    vps::device::JointVector values = vps::device::toVector(reading.joints);
    double& value = values[detail_ % 7];
    const double size = (detail_ / 7 + 1) * 0.01;
    if (trouble_ == kNan) value = detail_ % 2 == 0 ? std::nan("") : -std::numeric_limits<double>::infinity();
    if (trouble_ == kHuge) value = 1e300;
    if (trouble_ == kJump) value += detail_ % 2 == 0 ? size : -size;
    if (trouble_ == kApart) values[2] -= size;
    if (trouble_ == kDrift) drift_ += vps::device::JointVector::Constant(1e-4 * (detail_ % 5));
    reading.has_left = trouble_ != kLeftLost;
    reading.has_right = trouble_ != kRightLost;
    if (trouble_ == kClockBack) reading.time_s -= 1e-3 * (detail_ % 64);
    if (trouble_ == kClockNan) reading.time_s = std::nan("");
    reading.joints = vps::device::fromVector(values + drift_);
    if (trouble_ == kSilent) return last_;
    return last_ = reading;
  }

  void drive(const vps::device::JointVector& efforts) noexcept override {
    require_(efforts.allFinite(), "motor efforts are finite");
    const vps::device::JointVector peak = vps::device::motorLimits(plant_.settings().arms, 1);
    require_((efforts.cwiseAbs() - peak).maxCoeff() <= 0, "no motor command exceeds the motor's peak");
    plant_.drive(efforts);
  }

 private:
  vps::device::DualArmPlant& plant_;
  Require require_;
  Trouble trouble_ = kNone;
  unsigned detail_ = 0;
  bool has_lied_ = false;
  vps::device::JointVector drift_ = vps::device::JointVector::Zero();
  vps::device::DualArmReading last_;
};

struct HostileRun {
  bool has_faulted = false, has_recovered = false;
  double strongest_N = 0;
};

/// Runs the sequence: the first two bytes choose gains and the hand, and each tick takes two more. After the
/// last tick of the sequence the hardware works correctly again, the handle is held still, and re-arming must
/// bring the arm back.
inline HostileRun runHostile(const std::uint8_t* data, std::size_t size, Require require) {
  using namespace vps;
  HostileRun run;
  if (size < 2) return run;
  device::DualArmPlantSettings plant_settings;
  plant_settings.seed = data[0] + 1u;
  device::DualArmPlant plant(plant_settings);
  const device::DualArmParameters& p = plant_settings.arms;
  HostileArm hardware(plant, require);
  device::DeviceEventQueue events;
  device::DualArmController controller(hardware, {p, 1000, true, false, false}, &events);
  device::CouplingPort port;

  device::LoopSettings settings;
  settings.gains = device::deriveGains(controller.limits(), {});
  static constexpr double kBad[] = {std::numeric_limits<double>::quiet_NaN(), -5, 1e300, 1e5};
  const bool has_bad_gains = data[0] % 8 == 0, is_usable = !has_bad_gains || data[0] / 8 % 4 == 3;
  if (has_bad_gains) settings.gains.k_N_per_m = kBad[data[0] / 8 % 4];
  settings.safety.force_N = p.force_peak_N;
  settings.safety.torque_Nm = p.torque_peak_Nm;
  settings.physics_limit_s = 0.02;
  settings.events = &events;
  device::HapticLoop loop(controller, port, settings);
  loop.grasp(Pose{});
  CouplingState part{Pose{}, Twist{}, 0, true};
  port.physics.write({part, 0, {}, {}});

  device::HandForce hand = firmHand(300, 20);
  hand.F.f = 0.1 * (data[1] - 128.0) * Vec3::Unit(data[1] % 3);

  std::uint64_t faults_told = 0;
  int silent_ticks = 0;  // ticks without a new state from physics
  const auto check = [&] {
    const Wrench& F = loop.last().F_hand_D;
    require(F.isFinite(), "the wrench is finite");
    require(F.f.norm() <= p.force_peak_N * (1 + 1e-12), "the force stays within its limit");
    require(F.tau.norm() <= p.torque_peak_Nm * (1 + 1e-12), "the torque stays within its limit");
    const bool is_faulted = loop.safety().fault != device::SafetyFault::None;
    run.has_faulted = run.has_faulted || is_faulted;
    if (is_faulted) require(F.f.isZero() && F.tau.isZero(), "no wrench while a fault is latched");
    if (silent_ticks > 22 && loop.isHolding()) require(is_faulted, "physics that stalls is a fault");
    device::DeviceEvent event;
    while (events.pop(event))
      if (device::severityOf(event.kind) == device::Severity::Fault) ++faults_told;
    require(faults_told >= loop.safety().faults, "every fault is reported");
    if (controller.hasFault() && controller.fault() != device::DeviceEventKind::PeerLost)
      require(controller.efforts().isZero(), "motors are released after a fault");
    Wrench felt;
    if (hardware.hasLied() || device::handleWrench(p, plant.pose(), controller.efforts(), felt) != Status::Ok)
      return;
    felt.f.z() -= 9.81 * p.handle_kg;
    run.strongest_N = std::max(run.strongest_N, felt.f.norm());
    // The pose has an error of 0.1 mm and 2 mrad, with lever arms of 0.1 m and more; in motion it is a tick
    // old.
    require(felt.f.norm() <= 1.02 * p.force_peak_N + 0.2, "the force on the hand stays within the limit");
  };
  const auto tick = [&](bool is_asked, bool is_physics_alive = true, double dt_s = 1e-3) {
    if (is_asked) {
      if (is_physics_alive) port.physics.write({part, 0, {}, {}});
      silent_ticks = is_physics_alive ? 0 : silent_ticks + 1;
      loop.tick(dt_s);
      check();
    }
    plant.step(1e-3, hand);
    part.time_s = plant.time_s();
  };

  for (std::size_t i = 2; i + 1 < size; i += 2) {
    const unsigned code = data[i] % 32, detail = data[i + 1];
    hardware.set(code < HostileArm::kTroubles ? static_cast<HostileArm::Trouble>(code) : HostileArm::kNone,
                 detail);
    part.X_W.p = Vec3::Zero();
    if (code == 12) part.X_W.p = Vec3(detail * 1e-3, 0, 0);  // physics throws the part away
    if (code == 13) part.X_W.p.x() = std::nan("");
    if (code == 14) part.V_W.v = Vec3::Constant(detail * 1e10);
    if (code == 15) part.V_W.v.setZero();
    if (code == 16) loop.rearm();
    if (code == 17) hand.F.f = 0.2 * (detail - 128.0) * Vec3::Unit(detail % 3);
    if (code == 18) loop.release();
    if (code == 19) loop.grasp(Pose{});
    const int times = code == HostileArm::kSilent || code == 20 || code == 21 ? 1 + detail % 40 : 1;
    static constexpr double kOdd_s[] = {std::numeric_limits<double>::quiet_NaN(), -1, 0, 1e300};
    const double dt_s = code == 22 ? kOdd_s[detail % 4] : 1e-3;
    for (int t = 0; t < times; ++t)
      tick(code != 20, code != 21, dt_s);  // 20: the loop is not called; 21: physics stalls
  }

  // The hardware works correctly again.
  hardware.set(HostileArm::kNone, 0);
  part = {Pose{}, Twist{}, plant.time_s(), true};
  hand.F = {};
  for (int i = 0; i < 400; ++i) tick(true);
  loop.rearm();
  loop.release();
  for (int i = 0; i < 5; ++i) tick(true);
  run.has_recovered = loop.safety().fault == device::SafetyFault::None && !controller.hasFault();
  // An encoder that has drifted needs a calibration; all other faults must be gone.
  Pose X_read = loop.last().X_WG;
  const bool is_true = (X_read.p - plant.pose().p).norm() < 1e-3 || !hardware.hasLied();
  if (is_usable && is_true) require(run.has_recovered, "re-arming brings the arm back");
  if (!is_usable) require(!run.has_recovered, "gains out of range never give force");
  return run;
}

}  // namespace vps_test
