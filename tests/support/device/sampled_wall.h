// SPDX-License-Identifier: BSD-3-Clause
// A sampled wall in one direction: the energy that it can generate, by formula and as measured with our own
// loop, and the stiffness at which it rings on a device of one mass.
//
//   wall:   F = -K x - B (x - x_before) / T, computed once a period T, acts t_d later, held for a period
//   device: mass m, damping b, pushed by a constant force
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "vps_device/dual_arm/simulated_dual_arm.h"
#include "vps_device/gains.h"
#include "vps_device/loop.h"

namespace vps::test {

struct SampledWall {
  double K_N_per_m = 1000, B_Ns_per_m = 0, period_s = 1e-3, delay_s = 0;
};

/// K (T/2 + t_d) + |B| [N s/m]: on a device with less damping the wall is active (device/README.md,
/// "Stability of the coupling").
inline double passiveDampingFormula(const SampledWall& w) {
  return w.K_N_per_m * (w.period_s / 2 + w.delay_s) + std::abs(w.B_Ns_per_m);
}

/// K = (b + B) / (T/2 + t_d): the stiffness at which the wall rings on a device of damping b.
inline double ringingFormula(const SampledWall& w, double damping_Ns_per_m) {
  return (damping_Ns_per_m + w.B_Ns_per_m) / (w.period_s / 2 + w.delay_s);
}

/// The least device damping [N s/m] that dissipates all energy which the wall can generate in a motion whose
/// samples are a sine with `angle_rad` = w T per period, 0 < angle_rad <= pi. Exact.
///   whole ticks of delay d:  b = T/2 G,  G = Re{(1 - e^-jwT) H e^-jwTd} / (1 - cos wT),
///   H = K + B (1 - e^-jwT) / T                                             [Colgate and Schenkel 1997]
/// since the straight path between two samples dissipates least while one force is held. If the force changes
/// at a share phi of the period, a hand that moves faster under the lesser force gains phi (1 - phi) T |H|^2
/// / (4 b) more for each unit step, so that b is the root of a quadratic equation.
inline double passiveDampingAt(const SampledWall& w, double angle_rad) {
  using Complex = std::complex<double>;
  const double ticks = w.delay_s / w.period_s, whole = std::floor(ticks + 1e-9);
  const double phi = std::max(0.0, ticks - whole);
  const Complex lag = std::polar(1.0, -angle_rad);
  const Complex H = w.K_N_per_m + w.B_Ns_per_m / w.period_s * (1.0 - lag);
  const Complex held = std::polar(1.0, -angle_rad * whole) * (1 - phi + phi * lag);
  const double G = ((1.0 - lag) * H * held).real() / (1 - std::cos(angle_rad));
  if (phi < 1e-9) return w.period_s / 2 * G;
  return w.period_s / 2 * (G / 2 + std::sqrt(G * G / 4 + phi * (1 - phi) * std::norm(H)));
}

/// A frequency [rad per sample] of which whole periods fit into kSineSamples: index 1 to kSineSamples / 2.
inline constexpr int kSineSamples = 400;
inline double sineAngle_rad(int index) {
  return 2 * std::numbers::pi * index / kSineSamples;
}

/// The greatest passiveDampingAt() over all frequencies, searched in steps of pi/200. The terms are sines of
/// up to six times the angle, so the search misses their maximum by at most (6 pi/400)^2 / 2 = 0.1%.
inline double passiveDamping(const SampledWall& w) {
  double most = 0;
  for (int i = 1; i <= kSineSamples / 2; ++i) most = std::max(most, passiveDampingAt(w, sineAngle_rad(i)));
  return most;
}

/// The coupling state of a part at rest at the scene's origin.
inline CouplingState stillPart() {
  return {Pose{}, Twist{}, 0, true};
}

/// Settings of a loop with this wall's gains and without limits, so that only the sampled law acts.
inline device::LoopSettings wallLoop(const SampledWall& w) {
  device::LoopSettings settings;
  settings.period_s = w.period_s;
  settings.gains.k_N_per_m = w.K_N_per_m;
  settings.gains.b_Ns_per_m = w.B_Ns_per_m;
  settings.gains.max_force_N = 1e3;
  settings.safety.force_N = settings.safety.jump_m = 1e9;
  settings.safety.slew_N_per_s = settings.safety.slew_Nm_per_s = 1e12;
  settings.has_passivity_controller = false;
  return settings;
}

/// A handle on a rail along x. The device's position is set directly or moved by mass, damping and force; the
/// device keeps the wrenches that were written.
class RailDevice final : public device::Device {
 public:
  explicit RailDevice(double period_s) : period_s_(period_s) {}

  device::DeviceSample read() noexcept override {
    device::DeviceSample sample;
    sample.X_DH.p.x() = x_m;
    sample.V_DH.v.x() = (x_m - x_read_m_) / period_s_;
    sample.time_s = time_s_;
    x_read_m_ = x_m;
    time_s_ += period_s_;
    return sample;
  }
  void write(const Wrench& F) noexcept override {
    std::rotate(written_N_.begin(), written_N_.end() - 1, written_N_.end());
    written_N_[0] = F.f.x();
  }
  [[nodiscard]] device::DeviceLimits limits() const noexcept override { return {}; }
  [[nodiscard]] std::string_view name() const noexcept override { return "rail"; }

  /// The force that was written `ticks` ticks (below 16) before the last one.
  [[nodiscard]] double force_N(int ticks) const { return written_N_[static_cast<std::size_t>(ticks)]; }

  /// Advances m x'' = push - b x' + F by one period, exactly, with F constant.
  void move(double mass_kg, double damping_Ns_per_m, double force_N) {
    const double decay = std::exp(-damping_Ns_per_m * period_s_ / mass_kg);
    const double v_end_m_s = force_N / damping_Ns_per_m;
    x_m += v_end_m_s * period_s_ + (v_m_s - v_end_m_s) * mass_kg / damping_Ns_per_m * (1 - decay);
    v_m_s = v_end_m_s + (v_m_s - v_end_m_s) * decay;
  }

  double x_m = 0, v_m_s = 0;

 private:
  double period_s_, x_read_m_ = 0, time_s_ = 0;
  std::array<double, 16> written_N_{};
};

/// Measures passiveDampingAt() for whole ticks of delay: a hand leads the handle along a sine while our loop
/// renders the wall. The result is the work of the wall on the handle over the work that a damper of 1 N s/m
/// would dissipate.
inline double measuredPassiveDamping(const SampledWall& w, int index) {
  RailDevice device(w.period_s);
  device::CouplingPort port;
  port.physics.write({stillPart(), 0, {}, {}});
  device::HapticLoop loop(device, port, wallLoop(w));
  loop.grasp(Pose{});  // at x = 0, the position of the part
  const int delay = static_cast<int>(std::lround(w.delay_s / w.period_s));
  const double reach_m = 1e-3;
  const auto led_m = [&](int k) { return reach_m * std::sin(sineAngle_rad(index) * k + 0.3); };
  double work_J = 0, damper_J = 0;
  for (int k = -20; k < kSineSamples; ++k) {
    device.x_m = led_m(k);
    loop.tick();
    if (k < 0) continue;
    const double step_m = led_m(k + 1) - led_m(k);
    work_J += device.force_N(delay) * step_m;
    damper_J += step_m * step_m / w.period_s;
  }
  return work_J / damper_J;
}

/// Whether the oscillation of a handle grows that is pushed against the wall by a constant force and
/// displaced a little from rest. Our loop renders the wall, with whole ticks of delay.
inline bool rings(const SampledWall& w, double mass_kg, double damping_Ns_per_m) {
  RailDevice device(w.period_s);
  device::CouplingPort port;
  port.physics.write({stillPart(), 0, {}, {}});
  device::HapticLoop loop(device, port, wallLoop(w));
  loop.grasp(Pose{});
  const double push_N = 5, rest_m = push_N / w.K_N_per_m;
  device.x_m = 0.9 * rest_m;
  // Near the limit of stability the amplitude changes by 2 pi (relative distance from the limit) zeta per
  // period, so two intervals of thirty periods show the trend.
  const double turn_s = 2 * std::numbers::pi * std::sqrt(mass_kg / w.K_N_per_m);
  const int delay = static_cast<int>(std::lround(w.delay_s / w.period_s));
  const int ticks = static_cast<int>(30 * turn_s / w.period_s);
  double swing_m[3] = {};
  for (int part = 0; part < 3; ++part)
    for (int k = 0; k < ticks; ++k) {
      loop.tick();
      device.move(mass_kg, damping_Ns_per_m, push_N + device.force_N(delay));
      swing_m[part] = std::max(swing_m[part], std::abs(device.x_m - rest_m));
      if (swing_m[part] > 10 * rest_m) return true;
    }
  return swing_m[2] > swing_m[1];
}

/// The stiffness [N/m] at which ringing begins, by bisection to 0.2% between a quarter and four times the
/// formula.
inline double measuredRinging(SampledWall w, double mass_kg, double damping_Ns_per_m) {
  double low = ringingFormula(w, damping_Ns_per_m) / 4, high = 16 * low;
  while (high / low > 1.002) {
    w.K_N_per_m = std::sqrt(low * high);
    (rings(w, mass_kg, damping_Ns_per_m) ? high : low) = w.K_N_per_m;
  }
  return std::sqrt(low * high);
}

// -- The dual arm, pushed by a hand against a wall that our loop renders: whether it comes to rest, and up to
// which stiffness.

struct WallPress {
  double hand_kg = 0.1;  ///< a fingertip's grip: little inertia, and no damping of its own
  double push_N = 5;
  Vec3 along_D = Vec3(0, 0, -1);
  double settle_s = 1.5, watch_s = 0.5;
};

/// Peak-to-peak motion of the true handle [m] along the push.
struct Unrest {
  double early_m = 0;  ///< in the watch_s after a third of settle_s
  double late_m = 0;   ///< in the watch_s after settle_s
};

/// The part in hand is at rest, like a part that a rigid wall stops; our loop renders the coupling to this
/// part. The simulated arm takes eight steps per period, because its integrator moves with the velocity at
/// the end of a step, which shortens the effective time for which a force is held by half a step.
inline Unrest pressOnWall(const device::SimulatedDualArmSettings& device, const CouplingGains& gains,
                          const WallPress& press = {}) {
  device::SimulatedDualArm arm(device);
  device::CouplingPort port;
  device::LoopSettings settings;
  settings.gains = gains;
  settings.period_s = 1 / device.rate_hz;
  settings.has_passivity_controller = false;
  device::HapticLoop loop(arm, port, settings);
  loop.grasp(Pose{});
  port.physics.write({{Pose{}, Twist{}, 0, true}, 0, {}, {}});
  device::HandForce hand;
  hand.mass_kg = press.hand_kg;
  hand.inertia_kgm2 = 1e-4;
  hand.F.f = press.push_N * press.along_D;
  // The other fingers hold the rotation, since the wall acts on translation only.
  hand.k_Nm_per_rad = Mat3::Identity();
  hand.b_Nms_per_rad = 0.02 * Mat3::Identity();
  hand.X_eq = arm.truePose();
  double low_m[2] = {1e9, 1e9}, high_m[2] = {-1e9, -1e9};
  const double starts_s[2] = {press.settle_s / 3, press.settle_s};
  constexpr int kSubSteps = 8;
  for (double t_s = 0; t_s < press.settle_s + press.watch_s; t_s += settings.period_s) {
    loop.tick();
    for (int i = 0; i < kSubSteps; ++i) arm.step(settings.period_s / kSubSteps, hand);
    const double along_m = press.along_D.dot(arm.truePose().p);
    for (int w = 0; w < 2; ++w) {
      if (t_s < starts_s[w] || t_s > starts_s[w] + press.watch_s) continue;
      low_m[w] = std::min(low_m[w], along_m);
      high_m[w] = std::max(high_m[w], along_m);
    }
  }
  return {high_m[0] - low_m[0], high_m[1] - low_m[1]};
}

/// The greatest stiffness of the coupling [N/m] below the first one with a limit cycle, to 2%. A limit cycle
/// is a motion of more than half the encoders' greatest error, which is about one encoder step in the middle
/// of the workspace; the jitter of the encoders causes less. There must be no limit cycle at `from_N_per_m`.
/// Limit cycles are not monotonic in the stiffness, so the search goes upwards from `from_N_per_m` in steps
/// of 10%, and bisects only the last step.
inline double stiffestWall(const device::SimulatedDualArmSettings& device, CouplingGains gains,
                           double from_N_per_m, const WallPress& press = {}) {
  const double still_m = device.arms.resolution_m / 2;
  const auto cycles = [&](double K_N_per_m) {
    gains.k_N_per_m = K_N_per_m;
    return pressOnWall(device, gains, press).late_m > still_m;
  };
  double low = from_N_per_m, high = low;
  while (high < 1e6 && !cycles(high)) {
    low = high;
    high *= 1.1;
  }
  while (high / low > 1.02) {
    const double middle = std::sqrt(low * high);
    (cycles(middle) ? high : low) = middle;
  }
  return low;
}

}  // namespace vps::test
