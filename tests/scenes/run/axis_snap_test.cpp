// SPDX-License-Identifier: BSD-3-Clause
#include "world/axis_snap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>

#include "support/random_draw.h"
#include "support/recorded.h"
#include "support/temporary_folder.h"
#include "vps_scenes/run/assemble.h"
#include "vps_scenes/run/replay.h"

namespace vps::scenes {
namespace {

/// A block of 20 mm, held 20 mm above its place on a plate, so that it touches no other part.
Scene blockAbove() {
  Scene scene;
  scene.file = "scene.toml";
  scene.parts.resize(2);
  scene.parts[0].part = {"plate", makeBox({60e-3, 60e-3, 4e-3}), {}, {}};
  scene.parts[0].is_fixed = true;
  scene.parts[1].part = {"block", makeBox({20e-3, 20e-3, 20e-3}), {}, {}};
  scene.steps.resize(1);
  scene.steps[0].part = 1;
  scene.steps[0].X_WP_target = Pose::translation({0, 0, 12e-3});
  scene.steps[0].X_WP_start = Pose::translation({0, 0, 32e-3});
  scene.gravity_W = Vec3::Zero();
  scene.fidelity.haptic_rate_hz = scene.fidelity.physics_rate_hz = 250;
  scene.release_s = 0.1;
  scene.device.kind = "mouse";
  return scene;
}

constexpr double kPeak_N = 10.0 / 3, kPeak_Nm = 1.0 / 3;  // a third of the mouse's 10 N and 1 N m

AxisSnap snapOfBlock() {
  device::DeviceLimits limits;
  limits.peak_force_N = 10;
  limits.peak_torque_Nm = 1;
  const auto snap = axisSnap(blockAbove().steps[0], Vec3::Zero(), limits, 0.06, 4e-6, 4e-3);
  EXPECT_TRUE(snap);
  return *snap;
}

TEST(AxisSnap, ASpringsEnergyIsTheIntegralOfItsForceAndItLetsGoSmoothly) {
  const ReachingSpring spring = ReachingSpring::withPeak(1000, 3);
  EXPECT_NEAR(spring.force(spring.reach / std::sqrt(5.0)), 3, 1e-12);
  double sum_J = 0, greatest_N = 0;
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {  // midpoint rule: error 1e-9 of the whole
    const double x = 1.2 * spring.reach * (i + 0.5) / kSteps;
    sum_J += spring.force(x) * 1.2 * spring.reach / kSteps;
    greatest_N = std::max(greatest_N, spring.force(x));
  }
  EXPECT_NEAR(spring.energy_J(1.2 * spring.reach), sum_J, 1e-6 * sum_J);
  EXPECT_NEAR(greatest_N, 3, 1e-6);
  EXPECT_EQ(spring.force(1.01 * spring.reach), 0);
  EXPECT_LT(spring.force(0.999 * spring.reach), 1e-4);
}

TEST(AxisSnap, PullsToTheAxisAndLeavesThePartFreeAlongAndAboutIt) {
  const AxisSnap snap = snapOfBlock();
  const Wrench on_axis = snap.wrench({rotationFromVector(Vec3(0, 0, 1.0)), Vec3(0, 0, 0.5)});
  EXPECT_LT(on_axis.f.norm() + on_axis.tau.norm(), 1e-12);
  const Wrench beside = snap.wrench(Pose::translation({1e-3, 0, 0.02}));
  EXPECT_LT(beside.f.x(), -0.5);
  EXPECT_NEAR(beside.f.z(), 0, 1e-15);
  const Wrench tilted = snap.wrench({rotationFromVector(Vec3(0.05, 0, 0)), Vec3::Zero()});
  EXPECT_LT(tilted.tau.x(), 0) << "turns it back";
}

TEST(AxisSnap, IsConservativeAndStaysBelowAThirdOfTheDevicesForce) {
  const AxisSnap snap = snapOfBlock();
  std::mt19937 random(3);
  std::normal_distribution<double> draw;
  for (int i = 0; i < 200; ++i) {
    const Vec3 turn_rad = 0.2 * test::drawnVector(draw, random), p_W = 3e-3 * test::drawnVector(draw, random);
    const Pose X(rotationFromVector(turn_rad), p_W);
    const Wrench F = snap.wrench(X);
    EXPECT_LE(F.f.norm(), kPeak_N * (1 + 1e-12));
    EXPECT_LE(F.tau.norm(), kPeak_Nm * (1 + 1e-12));
    constexpr double kStep = 1e-6;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 d = kStep * Vec3::Unit(axis);
      const double slope_N =
          (snap.energy_J({X.R, Vec3(X.p + d)}) - snap.energy_J({X.R, Vec3(X.p - d)})) / (2 * kStep);
      EXPECT_NEAR(F.f[axis], -slope_N, 1e-5);
      const auto turned = [&](double sign) { return Pose(Mat3(rotationFromVector(sign * d) * X.R), X.p); };
      const double slope_Nm = (snap.energy_J(turned(1)) - snap.energy_J(turned(-1))) / (2 * kStep);
      EXPECT_NEAR(F.tau[axis], -slope_Nm, 1e-5);
    }
  }
}

TEST(AxisSnap, APathWithoutALastLegHasNoAxis) {
  SceneStep step = blockAbove().steps[0];
  step.X_WP_start = step.X_WP_target;
  EXPECT_FALSE(axisSnap(step, Vec3::Zero(), {}, 1, 1, 1e-3));
}

/// The hand pulls the block 4 mm off its axis; later axis snap is switched on. Times are simulated: on a busy
/// machine, simulated time falls behind real time, by which the hand gives up.
struct Felt {
  double before_N = 0, after_N = 0, part_before_m = 0, part_after_m = 0;  ///< across the axis
  AssembleResult result;
};
Felt pullAside(const std::string& record, double pulled_s, double snapped_s) {
  Scene scene = blockAbove();
  scene.steps[0].timeout_s = 2.5;
  Felt felt;
  std::atomic<bool> snaps = false;
  AssembleOptions options;
  options.is_real_time = true;
  options.snaps = &snaps;
  options.wish = std::make_shared<device::HandleWish>();
  SnapshotTap tap;
  tap.give = [&](Snapshot&& shot) {
    tap.is_wanted = true;
    if (shot.step < 0 || !shot.has_hand || shot.time_s > 2.4) return;  // after 2.4 s the hand gives up
    (snaps ? felt.after_N : felt.before_N) = shot.F_hand_W.f.x();
    (snaps ? felt.part_after_m : felt.part_before_m) = shot.bodies[1].X_WP.p.x();
  };
  tap.is_wanted = true;
  options.tap = &tap;
  options.after_step = [&](double time_s) {
    if (time_s > pulled_s) options.wish->write(Pose::translation({4e-3, 0, 0}));
    if (time_s > snapped_s) snaps = true;
  };
  felt.result = record.empty() ? assemble(scene, options) : assembleAndRecord(scene, record, options);
  return felt;
}

TEST(AxisSnap, IsFeltByTheHandThroughTheCoupling) {
  const Felt felt = pullAside("", 0.6, 1.5);
  EXPECT_NEAR(felt.part_before_m, 4e-3, 0.1e-3);
  EXPECT_LT(std::abs(felt.before_N), 0.1);
  const AxisSnap snap = snapOfBlock();
  // At rest the three springs in series carry the same force: the hand feels the force of the snap spring.
  EXPECT_NEAR(felt.after_N, -snap.line.force(felt.part_after_m), 0.05);
  EXPECT_LT(felt.after_N, -1);
  EXPECT_GT(felt.after_N, -kPeak_N);
  EXPECT_LT(felt.part_after_m, felt.part_before_m - 0.3e-3);
  // Switching axis snap on is work of the program, not of the loop. 1 mJ is the energy that the passivity
  // controller leaves.
  EXPECT_LT(felt.result.energy.injected_J, 1e-3);
}

TEST(AxisSnap, ARunByTheClockInWhichItIsSwitchedReplaysBitForBit) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path() / "run.mcap";
  const Felt felt = pullAside(file, 0.1, 0.3);
  const device::RecordedRun run = device::loadRecording(file);
  const auto is_switch = [](const device::LogEntry& entry) {
    const auto* event = std::get_if<device::SyncEvent>(&entry);
    return event != nullptr && event->kind == device::SyncEventKind::SnapOn;
  };
  EXPECT_EQ(std::ranges::count_if(run.entries, is_switch), 1);
  const ReplayResult replayed = replay(run);
  EXPECT_EQ(replayed.departure, "");
  EXPECT_EQ(replayed.equal, run.entries.size());
  test::expectSame(felt.result, replayed.result);
}

}  // namespace
}  // namespace vps::scenes
