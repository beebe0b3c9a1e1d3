// SPDX-License-Identifier: BSD-3-Clause
// The dual arm on a wall that our loop renders, pushed by a hand: does it come to rest, and up to which
// stiffness?
#pragma once

#include <algorithm>
#include <cmath>

#include "vps_device/dual_arm/simulated_dual_arm.h"
#include "vps_device/gains.h"
#include "vps_device/loop.h"

namespace vps::test {

struct WallPress {
  double hand_kg = 0.1;  ///< a fingertip's grip: little inertia, and no damping of its own
  double push_N = 5;
  Vec3 along_D = Vec3(0, 0, -1);
  double settle_s = 1.5, watch_s = 0.5;
};

/// How far the true handle moves to and fro [m] along the push.
struct Unrest {
  double early_m = 0;  ///< in the watch_s after a third of settle_s
  double late_m = 0;   ///< in the watch_s after settle_s
};

/// The part in hand stands still, as one that a rigid wall stops; our loop renders the coupling to it. The
/// plant takes eight steps a period: its integrator moves with the speed of a step's end, which would shorten
/// the hold of a force by half a step.
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
  // The other fingers hold the turns: the wall is one of translation.
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

/// The stiffest coupling [N/m] below the first with a limit cycle, to 2%. A cycle is motion of more than half
/// the encoders' greatest error, about one step of theirs in the middle of the workspace; the encoders'
/// jitter causes less. There must be no cycle at `from_N_per_m`. Whether there is one is not monotonic in the
/// stiffness, so the search goes upwards from there in steps of 10%, and bisects only the last step.
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
