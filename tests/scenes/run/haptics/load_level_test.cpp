// SPDX-License-Identifier: BSD-3-Clause
// Runs in real time with physics that is artificially too slow. The added loads are several times the
// duration of a step, and the periods are long, so that a busy machine can only add to the load.
#include "vps_scenes/run/load_level.h"
#include "support/units.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <string>

#include "core/machine.h"
#include "vps_scenes/run/assemble.h"

namespace vps::scenes {
namespace {

/// Two pins that are set down on a plate. Physics at 250 Hz.
Scene twoPins() {
  Scene scene;
  scene.file = scene.name = "pins";
  const auto add = [&](const std::string& name, const Vec3& size_m, const Vec3& p_WP, bool is_fixed) {
    ScenePart& part = scene.parts.emplace_back();
    part.part.name = name;
    part.part.mesh = makeBox(size_m);
    part.X_WP = Pose::translation(p_WP);
    part.is_fixed = is_fixed;
  };
  add("plate", {40 * kMm, 40 * kMm, 2 * kMm}, Vec3::Zero(), true);
  add("pin", {4 * kMm, 4 * kMm, 4 * kMm}, {0, 0, 3 * kMm}, false);
  add("twin", {4 * kMm, 4 * kMm, 4 * kMm}, {12 * kMm, 0, 3 * kMm}, false);
  for (const std::size_t i : {1u, 2u}) {
    SceneStep& step = scene.steps.emplace_back();
    step.part = i;
    step.X_WP_target = scene.parts[i].X_WP;
    step.X_WP_start = Pose::translation(scene.parts[i].X_WP.p + Vec3(0, 0, 20 * kMm));
    step.tolerance_m = 1 * kMm;  // the load level is tested, not the hand
  }
  scene.fidelity.haptic_rate_hz = 500;
  scene.fidelity.physics_rate_hz = 250;
  scene.release_s = 0.5;
  return scene;
}

void burn(double seconds) {
  for (const double until_s = wallSeconds() + seconds; wallSeconds() < until_s;) {
  }
}

/// A run in real time whose physics steps take load_s(time_s) longer, stopped after until_s of simulated
/// time.
AssembleResult run(Scene scene, double until_s, const std::function<double(double)>& load_s,
                   bool degrades = true) {
  std::atomic<bool> stop = false;
  AssembleOptions options;
  options.is_real_time = true;
  options.degrades = degrades;
  options.stop = &stop;
  options.after_step = [&](double time_s) {
    burn(load_s(time_s));
    stop = time_s > until_s;
  };
  return assemble(scene, options);
}

void expectInOrder(const std::vector<LoadLevelChange>& load_changes) {
  int level = 0;
  for (const LoadLevelChange& change : load_changes) {
    EXPECT_EQ(change.from, level);
    EXPECT_TRUE(change.is_done) << change.why;
    EXPECT_LE(std::abs(change.to - change.from), 1) << change.is;  // 0: the same level with new models
    EXPECT_FALSE(change.why.empty() || change.cost.empty());
    level = change.to;
  }
}

/// True if the load was shed level by level down to the third, and no further, without a fault of the loop.
bool stoppedAtThree(const AssembleResult& result) {
  const std::vector<LoadLevelChange>& changes = result.real_time->load_changes;
  for (std::size_t i = 0; i < 3; ++i)
    if (i >= changes.size() || changes[i].to != static_cast<int>(i + 1)) return false;
  return changes.back().to == 3 && result.real_time->faults == 0;
}

// 10 ms of load do not fit into periods of 4 and 8 ms, but into 16 ms. A machine that stops the run
// repeatedly for more than the 6 ms between load and period makes a further level right: such a run is made
// again.
TEST(LoadLevel, AnOverloadedRunReducesPointsThenRateAndStopsWhereItFits) {
  AssembleResult result;
  for (int attempt = 0; attempt < 4; ++attempt) {
    result = run(twoPins(), 2, [](double) { return 10e-3; });
    if (stoppedAtThree(result)) break;
  }
  const std::vector<LoadLevelChange>& load_changes = result.real_time->load_changes;
  ASSERT_GE(load_changes.size(), 3u);
  expectInOrder(load_changes);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(load_changes[i].to, static_cast<int>(i + 1)) << load_changes[i].is;
  EXPECT_EQ(load_changes[0].is, "points every 1 mm, physics at 250 Hz, time at the clock's");
  EXPECT_EQ(load_changes[2].is, "points every 1 mm, physics at 62.5 Hz, time at the clock's");
  EXPECT_GT(load_changes[0].lost_share, 0.5) << "10 ms begin three periods of 4 ms, of which two are lost";
  EXPECT_EQ(load_changes[0].unseen_bound_m, 1e-3);
  EXPECT_LT(load_changes[2].k_N_per_m, load_changes[1].k_N_per_m)
      << "a coupling that is passive at the lower rate is softer";
  EXPECT_EQ(load_changes.back().to, 3) << load_changes.back().is;
  EXPECT_GT(result.real_time->behind_s, 0.34) << "of 0.25 s each, three levels lose 0.6, 0.6 and 0.2";
  EXPECT_EQ(result.real_time->faults, 0u);
}

// The load ends after half a second. The hand holds the pin for longer than the 2 s after which a rate could
// be restored, but rates are restored only after the release; 9 s of rest are enough for four waits of 2 s.
TEST(LoadLevel, AfterTheLoadEndsAllLevelsAreRestoredInReverseOrder) {
  Scene scene = twoPins();
  scene.steps.resize(1);
  scene.parts[2].is_scenery = true;
  scene.release_s = 9;
  scene.steps[0].X_WP_start.p.z() += 40 * kMm;
  scene.steps[0].timeout_s = 60;
  scene.hand.speed_m_s = 0.02;
  const AssembleResult result = run(scene, 60, [](double time_s) { return time_s < 0.5 ? 10e-3 : 0; });
  const std::vector<LoadLevelChange>& load_changes = result.real_time->load_changes;
  expectInOrder(load_changes);
  ASSERT_FALSE(load_changes.empty());
  EXPECT_EQ(load_changes.back().to, 0) << load_changes.back().is;
  EXPECT_EQ(load_changes.back().cost, "the scene's own settings apply again");
  EXPECT_EQ(load_changes.back().k_N_per_m, load_changes.front().k_N_per_m)
      << "the coupling is as stiff as before";
  EXPECT_GT(result.steps[0].duration_s, 3) << result.steps[0].failure_reason << result.steps[0].final_error_m
                                           << "the hand must hold the part for longer than one wait";
  const double released_s = result.steps[0].start_s + result.steps[0].duration_s;
  for (const LoadLevelChange& change : load_changes) {
    if (change.to < change.from && change.from > 1) {
      EXPECT_GE(change.time_s, released_s) << "a coupling became stiffer while the hand held the part";
    }
  }
}

// At 100 Hz sixteen periods are longer than the watchdog's limit for physics (0.1 s); four are not.
TEST(LoadLevel, NoLevelIsTakenAtWhichTheWatchdogWouldSeeAStall) {
  Scene scene = twoPins();
  scene.fidelity.physics_rate_hz = 100;
  AssembleResult result;
  // Each level needs its models first, which a busy machine delays; one that stops the run for 50 ms more is
  // seen by the watchdog, rightly.
  for (const double until_s : {2.5, 5.0, 10.0}) {
    result = run(scene, until_s, [](double) { return 50e-3; });
    ASSERT_FALSE(result.real_time->load_changes.empty());
    if (!result.real_time->load_changes.back().is_done && result.real_time->faults == 0) break;
  }
  int most = 0;
  for (const LoadLevelChange& change : result.real_time->load_changes) most = std::max(most, change.to);
  EXPECT_EQ(most, 3);
  EXPECT_FALSE(result.real_time->load_changes.back().is_done) << "there is no further level";
  EXPECT_EQ(result.real_time->faults, 0u);
}

TEST(LoadLevel, WithoutLoadSheddingMissedPeriodsAreOnlyCounted) {
  const AssembleResult result = run(
      twoPins(), 0.5, [](double) { return 10e-3; }, false);
  EXPECT_TRUE(result.real_time->load_changes.empty());
  EXPECT_GT(result.real_time->physics_missed, result.physics.count) << "two of three periods";
}

// The number of points goes with the inverse square of their spacing, a period with the divisors.
TEST(LoadLevel, PointsAreReducedBeforeRateAndRateBeforeTime) {
  const std::vector<double> expected = {4, 2, 2, 2, 2};
  for (std::size_t level = 1; level < kLoadLevels.size(); ++level) {
    EXPECT_EQ(costRatio(level), expected[level - 1]) << level;
    const LoadLevel &now = kLoadLevels[level], &before = kLoadLevels[level - 1];
    if (now.rate_divisor > before.rate_divisor) {
      EXPECT_EQ(now.spacing_factor, 2) << level;
    }
    if (now.time_divisor > before.time_divisor) {
      EXPECT_EQ(now.rate_divisor, 4) << level;
    }
  }
}

TEST(LoadLevel, LockstepNeverShedsLoad) {
  Scene scene = twoPins();
  AssembleOptions options;
  options.after_step = [](double time_s) { burn(time_s < 0.5 ? 5e-3 : 0); };
  const AssembleResult slow = assemble(scene, options);
  Scene again = twoPins();
  const AssembleResult quick = assemble(again);
  EXPECT_FALSE(slow.real_time);
  ASSERT_EQ(slow.trace.size(), quick.trace.size());
  for (std::size_t i = 0; i < slow.trace.size(); ++i) {
    ASSERT_EQ(slow.trace[i].X_WP.p, quick.trace[i].X_WP.p) << i;
    ASSERT_EQ(slow.trace[i].F_hand_W.f, quick.trace[i].F_hand_W.f) << i;
  }
}

}  // namespace
}  // namespace vps::scenes
