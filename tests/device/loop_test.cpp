// SPDX-License-Identifier: BSD-3-Clause
// More than 400 lines: the tests share the rig of this file.
#include "vps_device/loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/no_alloc.h"
#include "vps_device/dual_arm/simulated_dual_arm.h"
#include "vps_device/gains.h"
#include "vps_device/random.h"

namespace vps::device {
namespace {

// A device that returns the test's sample and stores the written wrench.
class Puppet final : public Device {
 public:
  DeviceSample read() noexcept override { return sample; }
  void write(const Wrench& F) noexcept override { written = F; }
  [[nodiscard]] DeviceLimits limits() const noexcept override { return known; }
  [[nodiscard]] std::string_view name() const noexcept override { return "puppet"; }
  DeviceLimits known;
  DeviceSample sample;
  Wrench written;
};

CouplingState partAt(const Pose& X_W) {
  return {X_W, Twist{}, 0, true};
}

LoopSettings quick() {
  LoopSettings settings;
  settings.safety.slew_N_per_s = settings.safety.slew_Nm_per_s = 1e9;
  settings.safety.jump_m = settings.safety.jump_rad = 1e9;
  return settings;
}

TEST(WorkspaceMap, RoundTripIsTheIdentityAndPowerScalesAsStated) {
  const WorkspaceMap map{Pose(rotationFromVector(Vec3(0.3, 1, -2)), Vec3(1, 2, 3)), 2.5, 0.5};
  const Pose X(rotationFromVector(Vec3(1, 0.2, 0.3)), Vec3(0.1, -0.2, 0.3));
  const Pose back = map.toDevice(map.toScene(X));
  EXPECT_LT((back.p - X.p).norm() + (back.R - X.R).norm(), 1e-14);
  const Twist V{Vec3::Zero(), Vec3(0.1, 0.2, 0.3)};
  const Wrench F{Vec3(1, 2, 3), Vec3(4, 5, 6)};
  EXPECT_NEAR(power(map.toScene(F), map.toScene(V)), power(F, V) * map.scale / map.force_scale, 1e-13);
}

TEST(HapticLoop, GraspingAnywhereGivesNoForce) {
  Puppet device;
  CouplingPort port;
  LoopSettings settings = quick();
  settings.map = {Pose(rotationFromVector(Vec3(0.2, 0.1, 1)), Vec3(1, 0, 0)), 1.5, 1};
  HapticLoop loop(device, port, settings);
  device.sample.X_DH = Pose(rotationFromVector(Vec3(0.5, 0, 0.2)), Vec3(0.1, 0.1, 0));
  const Pose X_WG(rotationFromVector(Vec3(0, -1, 2)), Vec3(-3, 4, 5));
  loop.grasp(X_WG);
  port.physics.write({partAt(X_WG), 0, {}, {}});
  loop.tick();
  // The bound is a spring of 2000 N/m times a rounding of 1e-15.
  EXPECT_LT(device.written.f.norm() + device.written.tau.norm(), 1e-10);
  EXPECT_LT((port.haptic.read().proxy.X_W.p - X_WG.p).norm(), 1e-14);
}

TEST(HapticLoop, ForceOnTheHandPullsTowardsThePartInDeviceCoordinates) {
  Puppet device;
  CouplingPort port;
  LoopSettings settings = quick();
  settings.map.X_WD.R = rotationFromVector(Vec3(0, 0, M_PI / 2));  // device x is scene y
  HapticLoop loop(device, port, settings);
  loop.grasp(Pose{});
  port.physics.write({partAt(Pose{}), 0, {}, {}});
  device.sample.X_DH.p = Vec3(1e-3, 0, 0);
  const TickReport report = loop.tick();
  EXPECT_NEAR(report.X_WG.p.y(), 1e-3, 1e-15);
  EXPECT_NEAR(device.written.f.x(), -settings.gains.k_N_per_m * 1e-3, 1e-9);
  EXPECT_NEAR(report.F_hand_W.f.y(), -settings.gains.k_N_per_m * 1e-3, 1e-9);
}

TEST(HapticLoop, NothingIsFeltBeforePhysicsCouplesOrAfterRelease) {
  Puppet device;
  CouplingPort port;
  HapticLoop loop(device, port, quick());
  loop.grasp(Pose{});
  device.sample.X_DH.p = Vec3(1e-3, 0, 0);
  loop.tick();
  EXPECT_EQ(device.written.f, Vec3(Vec3::Zero()));
  port.physics.write({partAt(Pose{}), 0, {}, {}});
  loop.tick();
  EXPECT_GT(device.written.f.norm(), 1);
  loop.release();
  loop.tick();
  EXPECT_EQ(device.written.f, Vec3(Vec3::Zero()));
  EXPECT_FALSE(port.haptic.read().proxy.is_coupled);
}

TEST(HapticLoop, LostDeviceStopsForceAndProxyUntilRearmedAndThenRegrasps) {
  Puppet device;
  CouplingPort port;
  HapticLoop loop(device, port, quick());
  loop.grasp(Pose{});
  port.physics.write({partAt(Pose{}), 0, {}, {}});
  device.sample.X_DH.p = Vec3(1e-3, 0, 0);
  loop.tick();
  device.sample.status = Status::Fault;
  device.sample.X_DH.p = Vec3(0.3, 0, 0);
  EXPECT_EQ(loop.tick().status, Status::Fault);
  EXPECT_EQ(device.written.f, Vec3(Vec3::Zero()));
  EXPECT_NEAR(port.haptic.read().proxy.X_W.p.x(), 1e-3, 1e-15);
  device.sample.status = Status::Ok;
  loop.tick();
  EXPECT_EQ(device.written.f, Vec3(Vec3::Zero()));
  loop.rearm();
  for (int i = 0; i < 500; ++i) loop.tick();
  EXPECT_LT(device.written.f.norm(), 1e-9);
  EXPECT_NEAR(loop.last().X_WG.p.x(), 0, 1e-12);
  EXPECT_EQ(loop.count(Status::Fault), 2u);
  EXPECT_EQ(loop.count(Status::Ok), loop.ticks() - 2);
}

TEST(HapticLoop, JumpingPoseDoesNotDragThePartAlong) {
  Puppet device;
  CouplingPort port;
  HapticLoop loop(device, port, {});
  loop.grasp(Pose{});
  loop.tick();
  device.sample.X_DH.p = Vec3(0.2, 0, 0);
  EXPECT_EQ(loop.tick().status, Status::Fault);
  EXPECT_EQ(port.haptic.read().proxy.X_W.p, Vec3(Vec3::Zero()));
}

TEST(HapticLoop, InjectedEnergyIsDissipatedByTheDevicesSpareDamping) {
  Puppet device;
  device.known.damping_Ns_per_m = 5;
  CouplingPort port;
  LoopSettings settings = quick();
  settings.gains.k_N_per_m = 2000;
  settings.gains.b_Ns_per_m = 1;
  HapticLoop loop(device, port, settings);
  device.sample.V_DH.v = Vec3(0.1, 0, 0);
  loop.observeStoredEnergy(0, 0);
  loop.tick();
  loop.tick();
  EXPECT_EQ(device.written.f, Vec3(Vec3::Zero()));
  loop.observeStoredEnergy(0.5, 0);  // half a joule without a source
  loop.tick();                       // accounts for the energy
  loop.tick();                       // and damps
  EXPECT_NEAR(loop.passivity().injected_J, 0.5, 1e-12);
  EXPECT_NEAR(device.written.f.x(), -0.1 * (5 - 2000 * 0.5e-3 - 1), 1e-12);
}

TEST(HapticLoop, EnergyAccountSplitsWorkAndFindsNoneGeneratedInASpring) {
  Puppet device;
  CouplingPort port;
  HapticLoop loop(device, port, quick());
  const double k = loop.settings().gains.k_N_per_m;
  loop.grasp(Pose{});
  port.physics.write({partAt(Pose{}), 0, {}, {}});
  const double travel_m = 5e-3;
  const int n = 500;
  for (int i = 0; i <= 2 * n; ++i) {  // the handle moves out and back
    const double x = travel_m * (i <= n ? i : 2 * n - i) / n;
    device.sample.X_DH.p.x() = x;
    loop.tick();
    loop.observeStoredEnergy(0.5 * k * x * x, 0);
  }
  // The force is held: each of n steps of h has an error of k h^2 / 2, against the hand on the way out and
  // with it on the way back.
  const double stored_J = 0.5 * k * travel_m * travel_m, hold_J = 0.5 * k * travel_m * travel_m / n;
  EXPECT_NEAR(loop.passivity().from_hand_J, stored_J - hold_J, 1e-9);
  EXPECT_NEAR(loop.passivity().to_hand_J, stored_J + hold_J, 1e-9);
  EXPECT_NEAR(loop.passivity().injected_J, 2 * hold_J, 1e-9);
}

TEST(HapticLoop, TheErrorByQuantisationIsWithinItsBound) {
  const double step_m = 0.1e-3;  // readings are off by at most half a step
  for (const double rate_rad_s : {1.0, 7.0, 40.0}) {
    Puppet device;
    device.known.resolution_m = 0.5 * step_m;
    CouplingPort port;
    HapticLoop loop(device, port, quick());
    loop.grasp(Pose{});
    port.physics.write({partAt(Pose{}), 0, {}, {}});
    double true_J = 0, x_before_m = 0, greatest_J = 0;
    for (int i = 0; i < 3000; ++i) {
      const double x_m = 2e-3 * std::sin(rate_rad_s * i * 1e-3);
      true_J += device.written.f.x() * (x_m - x_before_m);  // the written force acts until the next tick
      x_before_m = x_m;
      device.sample.X_DH.p.x() = step_m * std::round(x_m / step_m);
      loop.tick();
      const PassivityObserver& ledger = loop.passivity();
      const double hidden_J = std::abs(true_J - (ledger.to_hand_J - ledger.from_hand_J));
      ASSERT_LE(hidden_J, ledger.quantisation_error_bound_J + 1e-12) << i;
      greatest_J = std::max(greatest_J, hidden_J);
    }
    EXPECT_GT(greatest_J, 1e-6);  // the error is not trivially zero
  }
}

// Moves the handle to x_m in one tick, with the energy stored_J stored in the scene.
void lead(HapticLoop& loop, Puppet& device, double x_m, double stored_J) {
  device.sample.X_DH.p.x() = x_m;
  loop.tick();
  loop.observeStoredEnergy(stored_J, 0);
}

TEST(HapticLoop, EarlyDissipationDoesNotOffsetLaterGeneration) {
  Puppet device;
  CouplingPort port;
  HapticLoop loop(device, port, quick());
  const double k = loop.settings().gains.k_N_per_m, x_m = 1e-3;
  loop.grasp(Pose{});
  lead(loop, device, 0, 0);
  port.physics.write({partAt(Pose::translation(Vec3(x_m, 0, 0))), 0, {}, {}});  // pulls by k x
  lead(loop, device, 0, 0);
  // The hand moves against the pull and nothing is stored: k x times 1 mm is dissipated.
  lead(loop, device, -x_m, 0);
  EXPECT_NEAR(loop.passivity().balance_J, -k * x_m * x_m, 1e-12);
  EXPECT_EQ(loop.passivity().injected_J, 0);
  // Half of the dissipated energy now appears without a source. The greatest balance over time is still the
  // initial zero.
  lead(loop, device, -x_m, 0.5 * k * x_m * x_m);
  EXPECT_LT(loop.passivity().balance_J, 0);
  EXPECT_NEAR(loop.passivity().injected_J, 0.5 * k * x_m * x_m, 1e-12);
}

TEST(HapticLoop, EnergyAccountUsesTheActingForceNotTheOneJustWritten) {
  for (const double ticks : {0.0, 1.0, 2.25}) {
    Puppet device;
    device.known.delay_s = ticks * 1e-3;
    CouplingPort port;
    HapticLoop loop(device, port, quick());
    const double k = loop.settings().gains.k_N_per_m, v_m = 1e-4;
    loop.grasp(Pose{});
    port.physics.write({partAt(Pose{}), 0, {}, {}});
    const int n = 50;
    for (int i = 0; i <= n; ++i) lead(loop, device, i * v_m, 0);
    // Step i ends at i v and feels k v (i - 1 - ticks), but no force from before the start, where a fraction
    // of a tick counts.
    double work_J = 0;
    for (int i = 1; i <= n; ++i) {
      const double late = ticks - std::floor(ticks), newer = i - 1 - std::floor(ticks);
      work_J += k * v_m * v_m * ((1 - late) * std::max(0.0, newer) + late * std::max(0.0, newer - 1));
    }
    EXPECT_NEAR(loop.passivity().from_hand_J, work_J, 1e-12) << ticks;
  }
}

// A wall at the end of a connection that takes 20 ticks: the energy of its spring belongs to the hand 20
// ticks ago. Balanced against the present hand, the motion since then would add 20 steps times the force, 20
// times the bound of this test.
TEST(HapticLoop, EnergyStoredWhenATickAgoWasAnsweredIsBalancedAgainstTheWorkUntilThatTick) {
  Puppet device;
  CouplingPort port;
  HapticLoop loop(device, port, quick());
  const double k = loop.settings().gains.k_N_per_m, travel_m = 5e-3;
  const int n = 500, late = 20;
  const auto at_m = [&](int i) {
    return travel_m * (i <= n ? i : std::max(0, 2 * n - i)) / n;
  };  // out and back
  loop.grasp(Pose{});
  for (int i = 0; i <= 2 * n + late; ++i) {
    CouplingState part = partAt(Pose{});
    if (i >= late) {
      part.time_s = 1e-3 * (i - late);
      port.physics.write({part, i - late + 1, 0.5 * k * at_m(i - late) * at_m(i - late), {}});
    } else {
      port.physics.write({part, 0, {}, {}});
    }
    device.sample.X_DH.p.x() = at_m(i);
    device.sample.time_s = 1e-3 * i;
    loop.tick();
  }
  const double hold_J = 0.5 * k * travel_m * travel_m / n;  // the same energy as without delay
  EXPECT_NEAR(loop.passivity().injected_J, 2 * hold_J, 1e-9);
}

TEST(HapticLoop, PublishesItsStateAfterEachTickAndObservesStoredEnergyOncePerStep) {
  Puppet device;
  CouplingPort port;
  HapticLoop loop(device, port, {});
  port.physics.write({partAt(Pose{}), 1, 1.0, {}});
  loop.tick();
  EXPECT_EQ(loop.passivity().balance_J, 0) << "the first observation";
  port.physics.write({partAt(Pose{}), 1, 2.0, {}});
  loop.tick();
  EXPECT_EQ(loop.passivity().balance_J, 0) << "the same step";
  port.physics.write({partAt(Pose{}), 2, 2.0, {}});
  loop.tick();
  EXPECT_EQ(loop.passivity().balance_J, 1);
  EXPECT_EQ(loop.received().step, 2);
  const HapticState& state = port.haptic.read();
  EXPECT_EQ(state.tick, 3);
  EXPECT_EQ(state.passivity.injected_J, 1);
  EXPECT_EQ(state.report.time_s, loop.last().time_s);
}

TEST(HapticLoop, TickNeverAllocates) {
  SimulatedDualArm arm;
  CouplingPort port;
  LoopSettings settings;
  settings.extrapolates_part = true;
  HapticLoop loop(arm, port, settings);
  loop.grasp(Pose{});
  const vps_test::NoAllocScope guard;
  for (int i = 0; i < 100; ++i) {
    port.physics.write({partAt(Pose::translation(Vec3(1e-3, 0, 0))), 0, {}, {}});
    loop.tick();
    arm.step(1e-3, loop.toDevice(HandForce{}));
  }
}

TEST(HapticLoop, GainsOutOfRangeGiveNoForceEvenWhenRearmed) {
  for (const double bad : {std::nan(""), -1.0, 1e300}) {
    Puppet device;
    CouplingPort port;
    LoopSettings settings = quick();
    settings.gains.k_N_per_m = bad;
    HapticLoop loop(device, port, settings);
    loop.grasp(Pose{});
    port.physics.write({partAt(Pose{}), 0, {}, {}});
    device.sample.X_DH.p = Vec3(1e-3, 0, 0);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(loop.tick().status, Status::Fault);
      EXPECT_EQ(device.written.f, Vec3(Vec3::Zero()));
      EXPECT_EQ(loop.safety().fault, SafetyFault::BadGains);
      loop.rearm();
    }
  }
}

TEST(Gains, AllowForTheDevicesOwnDelay) {
  DeviceLimits limits;
  limits.damping_Ns_per_m = 5;
  limits.delay_s = 1e-3;
  EXPECT_NEAR(deriveGains(limits, {1000, 1000, 0, 1, 1}).k_N_per_m, 0.8 * 4 / 2.5e-3, 1e-9);
}

TEST(Gains, FollowTheFormulasAndTheDevice) {
  DeviceLimits limits;
  limits.damping_Ns_per_m = 5;
  limits.damping_Nms_per_rad = 0.01;
  limits.peak_force_N = 30;
  limits.peak_torque_Nm = 2.5;
  const CouplingGains gains = deriveGains(limits, {1000, 1000, 0, 1, 1});
  EXPECT_NEAR(gains.b_Ns_per_m, 1, 1e-12);
  EXPECT_NEAR(gains.k_N_per_m, 0.8 * 4 / 1.5e-3, 1e-9);
  EXPECT_GT(5, gains.k_N_per_m * 1.5e-3 + gains.b_Ns_per_m);  // b > K (T/2 + t_d) + |B|
  limits.coulomb_N = 0.05;
  limits.resolution_m = 100e-6;
  EXPECT_NEAR(deriveGains(limits, {}).k_N_per_m, 0.8 * 2 * 0.05 / 100e-6, 1e-9);
  EXPECT_NEAR(deriveGains(limits, {1000, 1000, 0, 2, 1}).k_N_per_m, 0.4 * 2 * 0.05 / 100e-6, 1e-9);
}

// A part of mass m in physics at its own rate: coupled implicitly to the proxy, stopped by a rigid floor at z
// = 0.
struct FloorWorld {
  double mass_kg = 0.3, floor_z = 0;
  CouplingState part{Pose{}, Twist{}, 0, true};

  void step(const CouplingGains& gains, const CouplingState& proxy, double dt_s) {
    const double k = gains.k_N_per_m, b = gains.b_Ns_per_m;
    const Vec3 rhs = mass_kg * part.V_W.v + dt_s * (k * (proxy.X_W.p - part.X_W.p) + b * proxy.V_W.v);
    part.V_W.v = rhs / (mass_kg + dt_s * b + dt_s * dt_s * k);
    part.V_W.v.z() = std::max(part.V_W.v.z(), (floor_z - part.X_W.p.z()) / dt_s);
    part.X_W.p += dt_s * part.V_W.v;
    part.X_W.R = proxy.X_W.R;
    part.V_W.w = proxy.V_W.w;
  }
};

struct Press {
  double depth_m, force_N, ripple_N, injected_J, speed_m_s;
};

// Presses the part on the floor with 5 N of the hand's spring; ripple is over the last half second.
Press pressOnFloor(CouplingGains gains, int haptic_per_physics, double hand_k) {
  SimulatedDualArmSettings device;
  device.rate_hz = 1000.0 * haptic_per_physics;
  SimulatedDualArm arm(device);
  CouplingPort port;
  LoopSettings settings;
  settings.gains = gains;
  settings.period_s = 1 / device.rate_hz;
  HapticLoop loop(arm, port, settings);
  FloorWorld world;
  world.part.X_W = Pose::translation(Vec3(0, 0, 5e-3));
  loop.grasp(world.part.X_W);
  HandForce hand;
  hand.mass_kg = 0.3;  // a loose grip: the least damped case
  hand.inertia_kgm2 = 1e-3;
  hand.k_N_per_m = hand_k * Mat3::Identity();
  hand.b_Ns_per_m = 0.2 * std::sqrt(hand_k * hand.mass_kg) * Mat3::Identity();
  hand.k_Nm_per_rad = Mat3::Identity();
  hand.b_Nms_per_rad = 0.02 * Mat3::Identity();
  double low_N = 1e9, high_N = -1e9;
  for (int ms = 0; ms < 2000; ++ms) {
    port.physics.write({world.part, 0, {}, {}});
    const double down_m = -5.0 / hand_k;
    hand.X_eq = Pose::translation(Vec3(0, 0, 5e-3 + (down_m - 5e-3) * std::min(1.0, ms / 500.0)));
    for (int i = 0; i < haptic_per_physics; ++i) {
      loop.tick();
      arm.step(settings.period_s, loop.toDevice(hand));
      if (ms < 1500) continue;
      low_N = std::min(low_N, loop.last().F_hand_W.f.z());
      high_N = std::max(high_N, loop.last().F_hand_W.f.z());
    }
    world.step(gains, port.haptic.read().proxy, 1e-3);
  }
  return {-loop.last().X_WG.p.z(), 0.5 * (low_N + high_N), high_N - low_N, loop.passivity().injected_J,
          arm.trueTwist().v.norm()};
}

TEST(Coupling, DerivedGainsPressSteadilyOnARigidFloor) {
  for (const int haptic_per_physics : {1, 4}) {
    for (const double hand_k : {100.0, 500.0, 2000.0}) {
      const DeviceLimits limits = dualArmLimits({}, 1000.0 * haptic_per_physics, true);
      const CouplingGains gains = deriveGains(limits, {1000.0 * haptic_per_physics, 1000, 0, 1, 1});
      EXPECT_GT(gains.k_N_per_m, 1000);
      EXPECT_LT(gains.k_N_per_m, 5000);
      const Press press = pressOnFloor(gains, haptic_per_physics, hand_k);
      const double force_N = 5 * gains.k_N_per_m / (gains.k_N_per_m + hand_k);  // two springs in series
      // Dry friction may hold up to 0.35 N of the force; one encoder error of 0.1 mm moves the reading.
      EXPECT_NEAR(press.force_N, force_N, 0.35 + 1e-4 * gains.k_N_per_m) << hand_k;
      // One encoder error in the spring, and its speed through the filter (20 mm/s, both ways) in the damper.
      EXPECT_LT(press.ripple_N, 1e-4 * gains.k_N_per_m + 0.04 * gains.b_Ns_per_m) << hand_k;
      EXPECT_LT(press.speed_m_s, 2e-3) << hand_k;
    }
  }
}

TEST(Coupling, ThirtyTimesTheDerivedStiffnessOscillates) {
  // Well beyond the stability limit K = (b + B) / (T/2 + t_d), since dry friction stops weak oscillations.
  CouplingGains gains = deriveGains(SimulatedDualArm().limits(), {1000, 1000, 0, 1, 1});
  gains.k_N_per_m *= 30;
  EXPECT_GT(pressOnFloor(gains, 1, 100).ripple_N, 1);
}

}  // namespace
}  // namespace vps::device
