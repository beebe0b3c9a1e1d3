// SPDX-License-Identifier: BSD-3-Clause
// Rows with a haptic device: jerk of the hand.
#include <algorithm>
#include <cmath>

#include "drop.h"
#include "rows.h"
#include "vps/coupling_law.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/coupling.h"
#include "vps_device/dual_arm/simulated_dual_arm.h"
#include "vps_device/gains.h"
#include "vps_device/loop.h"
#include "watch.h"

namespace vps::stability {

namespace {

// A hand shakes the handle by 10 mm along a sine with this jerk, and the held block hits a plate in each
// period.
Judgement shake(const Run& run) {
  constexpr double amplitude_m = 10e-3, dt_s = 1e-3;
  const double turn_rad_s = std::cbrt(run.value / amplitude_m);
  World world({run.mode, true, dynamics::vpsEngine(kCoarse)});
  const PartMesh block_part = block();
  const Placed floor = world.add(plate(), Pose::translation(Vec3(0, 0, -5e-3)), true);
  const Placed block = world.add(block_part, Pose::translation(Vec3(0, 0, 5e-3 + amplitude_m / 2)));
  device::SimulatedDualArm device;
  device::LoopSettings settings;
  settings.gains = device::deriveGains(device.limits(), {});
  device::CouplingPort port;
  device::HapticLoop loop(device, port, settings);
  auto owned = std::make_unique<bullet::CouplingConstraint>(*block.body, Pose(), settings.gains);
  bullet::CouplingConstraint& coupling = *owned;
  world.addConstraint(std::move(owned));
  loop.grasp(bullet::fromBt(block.body->getWorldTransform()));
  device::HandForce hand;
  hand.k_N_per_m = 2000 * Mat3::Identity();
  hand.b_Ns_per_m = 20 * Mat3::Identity();
  hand.k_Nm_per_rad = 3 * Mat3::Identity();
  hand.b_Nms_per_rad = 0.1 * Mat3::Identity();
  hand.mass_kg = 0.5;
  hand.inertia_kgm2 = 0.001;
  double greatest_N = 0;
  Watching watching;
  watching.steps = 2000;
  watching.before_step = [&](int i) {
    loop.tick();
    greatest_N = std::max(greatest_N, loop.last().F_hand_W.f.norm());
    const double t_s = i * dt_s;
    hand.X_eq.p.z() = -amplitude_m * std::sin(turn_rad_s * t_s);
    hand.V_eq.v.z() = -amplitude_m * turn_rad_s * std::cos(turn_rad_s * t_s);
    device.step(dt_s, hand);
    coupling.setTarget(port.haptic.read().proxy);
    CouplingState part = coupling.partState();
    part.is_coupled = true;
    port.physics.write({part, 0, {}, {}});
    loop.observeStoredEnergy(
        energy_J(world, {block}) + couplingEnergy_J(settings.gains, port.haptic.read().proxy, part), 0);
  };
  const Watched watched = watch(world, {floor, block}, watching);
  Judgement judgement;
  judgement.require(watched.is_finite, "a pose or velocity is not a number");
  judgement.require(loop.safety().fault == device::SafetyFault::None,
                    std::string("safety: ") + toText(loop.safety().fault));
  const device::DeviceLimits limits = device.limits();
  judgement.atMost("force on the hand", greatest_N, limits.peak_force_N, "N");
  // Allowed overlap: a micrometre in constraint contact. Penalty contact yields to the greatest force, and to
  // an impact on a corner within one step.
  const double step_m = watched.fastest_m_s * dt_s;
  judgement.atMost("overlap", watched.deepest_m,
                   1e-6 + step_m * step_m / 10e-3 +
                       (run.mode == Mode::Penalty
                            ? std::sqrt(block_part.frame.mass_kg * 4 / (1e12 * 1e-6)) * watched.fastest_m_s
                            : 0),
                   "m");
  judgement.atMost("energy added", loop.passivity().injected_J, settings.injected_bound_J, "J");
  judgement.note("force " + toText(greatest_N) + " N, energy made " + toText(loop.passivity().injected_J) +
                 " J");
  return judgement;
}

}  // namespace

std::vector<Row> deviceRows() {
  return {{"jerk",
           "jerk of a hand that shakes a held block against a plate [m/s^3]",
           "safety, force, overlap",
           {10, 100, 1e3, 1e4, 1e5, 1e6},
           2,
           shake}};
}

}  // namespace vps::stability
