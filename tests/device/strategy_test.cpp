// SPDX-License-Identifier: BSD-3-Clause
// Strategies of the virtual operator: the spiral search on a part that friction holds, and the screwing of a
// part in a world of springs, without a device and without friction, onto a thread by formula.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "operator/sequence.h"
#include "vps_device/operator.h"

namespace vps::device {
namespace {

TEST(Strategy, EachHasANameARowInTheDocumentationAndAMaker) {
  std::ifstream in(std::string(VPS_SOURCE_DIR) + "/device/VIRTUAL_OPERATOR.md");
  const std::string page(std::istreambuf_iterator<char>(in), {});
  const Insertion insertion;  // makes all strategies
  for (std::size_t row = 1; row < kStrategies; ++row) {
    const std::string name = toText(static_cast<OperatorStrategy>(row));
    EXPECT_NE(page.find("| `" + name + "` |"), std::string::npos) << name;
  }
  EXPECT_STREQ(toText(OperatorStrategy::None), "none");
  EXPECT_STREQ(toText(OperatorStrategy::ScrewOn), "screw_on");
  EXPECT_STREQ(toText(static_cast<OperatorStrategy>(kStrategies)), "unknown");
  // Recordings store a strategy by the number of its row, so these numbers must not change.
  EXPECT_EQ(static_cast<int>(OperatorStrategy::Approach), 1);
  EXPECT_EQ(static_cast<int>(OperatorStrategy::ScrewOn), 11);
}

constexpr double kTick_s = 1e-3;

/// A part that a spring couples to the hand, pressed on a plane with Coulomb friction: it follows the hand at
/// a distance of up to friction / spring.
struct SlidingPart {
  double k_N_per_m = 1000, friction_N = 0;
  Vec3 part_m = Vec3::Zero(), hand_m = Vec3::Zero();

  void moveHand(const Vec3& to_m) {
    hand_m = to_m;
    const Vec3 behind_m = hand_m - part_m;
    const double held_m = friction_N / k_N_per_m;
    if (behind_m.norm() > held_m) part_m = hand_m - held_m * behind_m.normalized();
  }
  [[nodiscard]] Feel feel(double time_s, double push_N) const {
    Feel feel;
    feel.time_s = time_s;
    feel.resist_N = push_N;
    feel.across_m = feel.tip_m = part_m;
    feel.side_N = k_N_per_m * (part_m - hand_m);
    return feel;
  }
};

/// Greatest distance of the part from its start until the search ends.
double reachOfSearch(double friction_N) {
  Situation situation;
  SlidingPart sliding;
  sliding.friction_N = friction_N;
  const std::unique_ptr<Strategy> search = makeSpiralSearch();
  search->start(situation, sliding.feel(0, situation.habits.search_N));
  double farthest_m = 0;
  Outcome outcome = Outcome::GoingOn;
  for (double t_s = 0; outcome == Outcome::GoingOn && t_s < 60; t_s += kTick_s) {
    outcome = search->step(sliding.feel(t_s, situation.habits.search_N), kTick_s);
    sliding.moveHand(search->move().across_m);
    farthest_m = std::max(farthest_m, sliding.part_m.norm());
  }
  EXPECT_EQ(outcome, Outcome::Failed);  // there is no hole
  return farthest_m;
}

// A friction of 0.5 N deflects a spring of 1 kN/m by as much as the radius of the spiral: a hand that does
// not move ahead of the part would not move it at all.
TEST(SpiralSearch, LeadsAPartThatFrictionHolds) {
  const double limit_m = OperatorHabits().search_limit_m;
  for (const double friction_N : {0.0, 0.2, 0.5}) {
    EXPECT_GT(reachOfSearch(friction_N), 0.8 * limit_m) << friction_N << " N";
    EXPECT_LT(reachOfSearch(friction_N), 1.5 * limit_m) << friction_N << " N";
  }
}

// The part was backed off to before its hole, and sight has corrected its position since: it drops into the
// hole while it is lowered, past the depth of the first touch. The search ends when the part drops.
TEST(SpiralSearch, EndsWhereThePartDropsWhileItIsLowered) {
  Situation situation;
  situation.mouth_m = -14e-3;
  Feel feel;
  feel.along_m = situation.mouth_m - situation.habits.back_off_m;
  const std::unique_ptr<Strategy> search = makeSpiralSearch();
  search->start(situation, feel);
  Outcome outcome = Outcome::GoingOn;
  for (; outcome == Outcome::GoingOn && feel.time_s < 10; feel.time_s += kTick_s) {
    outcome = search->step(feel, kTick_s);
    feel.along_m = std::min(0.0, feel.along_m + 10e-3 * kTick_s);
    feel.resist_N = feel.along_m < 0 ? 0 : situation.habits.search_N;
  }
  EXPECT_EQ(outcome, Outcome::Done);
  EXPECT_LT(feel.along_m, situation.mouth_m + 1e-3);
}

constexpr double kTurn_rad = 2 * std::numbers::pi;

/// A nut above a bolt whose mouth is at z = 0. Turned back, the nut rides up a ramp; where the threads' ends
/// meet it drops onto the thread. `s` is the nut's turn in the direction that screws it on.
struct ThreadWorld {
  double pitch_m = 2e-3;
  double drop_m = 0.5e-3;       ///< height of the drop; 0: the hand feels no drop
  double ends_meet_rad = -2.5;  ///< the threads' ends meet at this angle plus any number of whole turns
  double along_share = 1;       ///< advance per turn, as a share of the pitch; 0: the thread does not catch
  double play_m = 0.2e-3;
  double target_m = -3e-3;  ///< height
  bool is_on = false;
  double s_rad = 0, on_rad = 0;

  /// The nut's lowest height.
  double floor_m(double s_now_rad) {
    const auto turnsBack = [this](double s) { return (ends_meet_rad - s) / kTurn_rad; };
    const bool passes = std::floor(turnsBack(s_now_rad)) > std::floor(turnsBack(s_rad));
    if (!is_on && passes && along_share > 0) {
      is_on = true;
      on_rad = s_now_rad;
    }
    // A nut that is turned back by more than the play allows comes off again.
    if (is_on && (on_rad - s_now_rad) / kTurn_rad * pitch_m > play_m) is_on = false;
    s_rad = s_now_rad;
    if (is_on) return -along_share * pitch_m * (s_now_rad - on_rad) / kTurn_rad - play_m;
    const double share = turnsBack(s_now_rad) - std::floor(turnsBack(s_now_rad));
    return drop_m * share;
  }
};

struct Screwed {
  OperatorPhase phase = OperatorPhase::Idle;
  double height_m = 0;      ///< height of the nut relative to its target
  double turned_rad = 0;    ///< turn of the nut at the end, in the direction that screws the nut on
  double drop_rad = 0;      ///< angle at which ScrewOn first began
  double farthest_rad = 0;  ///< turn of the handle from the middle of its range
  int retries = 0, grips = 0;
  std::vector<OperatorStrategy> strategies;
};

Screwed screwOn(ThreadWorld world, const ScrewTask& screw, double timeout_s = 60, std::uint64_t seed = 1) {
  constexpr double kCoupling_N_per_m = 1150, kStep_s = 1e-3;
  OperatorHabits habits;
  habits.seed = seed;
  OperatorTask task;
  task.X_WP_start = Pose::translation({0, 0, 5e-3});
  task.X_WP_target = Pose::translation({0, 0, world.target_m});
  task.tip_P = Vec3(10e-3, 0, -5e-3);
  task.tolerance_m = 0.5e-3;
  task.timeout_s = timeout_s;
  task.give_m_per_N = 1 / kCoupling_N_per_m;
  task.screw = screw;
  VirtualOperator hand(habits);
  hand.begin(task, 0);
  const double onward = screw.pitch_m < 0 ? -1 : 1;
  Screwed run;
  OperatorView view;
  view.X_WG_hand = view.X_WP = task.X_WP_start;
  double handle_rad = 0;
  for (; view.time_s < 2 * timeout_s; view.time_s += kStep_s) {
    const HandForce force = hand.step(view, kStep_s);
    const OperatorPhase phase = hand.phase();
    const OperatorStrategy strategy = hand.strategy();
    if (strategy != OperatorStrategy::None && (run.strategies.empty() || run.strategies.back() != strategy)) {
      if (strategy == OperatorStrategy::ScrewOn && run.drop_rad == 0) run.drop_rad = world.s_rad;
      run.strategies.push_back(strategy);
    }
    if (phase == OperatorPhase::Done || phase == OperatorPhase::Failed) break;
    if (phase == OperatorPhase::Regrasp) {
      ++run.grips;
      handle_rad = -hand.regraspTurn_rad().z();  // about the axis, which points down
      hand.goOn();
      continue;
    }
    // Springs in series from the hand's equilibrium to the nut; nothing resists across the axis or in
    // rotation.
    const Pose& X_eq = force.X_eq;
    const double turn_rad = -rotationVector(X_eq.R * view.X_WP.R.transpose()).z();
    handle_rad += turn_rad;
    run.farthest_rad = std::max(run.farthest_rad, std::abs(handle_rad));
    const double z_m = std::max(X_eq.p.z(), world.floor_m(world.s_rad + onward * turn_rad));
    const double k_N_per_m = force.k_N_per_m(2, 2);
    const double push_N = (z_m - X_eq.p.z()) / (1 / k_N_per_m + 1 / kCoupling_N_per_m);
    const Pose X_old = view.X_WP;
    view.X_WP = {X_eq.R, Vec3(X_eq.p.x(), X_eq.p.y(), z_m)};
    view.V_WP.v = (view.X_WP.p - X_old.p) / kStep_s;
    const Vec3 p_hand = X_eq.p + Vec3(0, 0, push_N / k_N_per_m);
    view.V_WG_hand.v = (p_hand - view.X_WG_hand.p) / kStep_s;
    view.V_WG_hand.w = rotationVector(X_eq.R * view.X_WG_hand.R.transpose()) / kStep_s;
    view.X_WG_hand = {X_eq.R, p_hand};
    view.F_hand_W.f = Vec3(0, 0, push_N);
  }
  run.phase = hand.phase();
  run.retries = hand.retries();
  run.height_m = task.X_WP_target.p.z() - view.X_WP.p.z();
  run.turned_rad = world.s_rad;
  return run;
}

constexpr ScrewTask kNut{.pitch_m = 2e-3, .handle_rad = 0.7};
constexpr double kHeight_m = 0.5e-3;  // five times see_error_m

TEST(Screw, TurnsBackUntilTheThreadDropsAndThenOnToTheHeightOfTheTarget) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Screwed run = screwOn({}, kNut, 60, seed);
    EXPECT_EQ(run.phase, OperatorPhase::Done) << seed;
    EXPECT_EQ(run.retries, 0) << seed;
    using enum OperatorStrategy;
    EXPECT_EQ(run.strategies, (std::vector{Approach, Touch, TurnBack, ScrewOn})) << seed;
    // The hand turns on at 1.2 rad/s for 0.15 s after the drop, and lags.
    EXPECT_NEAR(run.drop_rad, -2.5, 0.5) << seed;
    EXPECT_NEAR(run.height_m, 0, kHeight_m) << seed;
    // The nut moves 3 mm down from the mouth: one and a half turns from the drop, less the play.
    EXPECT_NEAR(run.turned_rad + 2.5, (3e-3 - 0.2e-3) / 2e-3 * kTurn_rad, kHeight_m / 2e-3 * kTurn_rad)
        << seed;
  }
}

TEST(Screw, ALeftHandThreadTurnsTheOtherWay) {
  ScrewTask left = kNut;
  left.pitch_m = -2e-3;
  const Screwed run = screwOn({}, left);
  EXPECT_EQ(run.phase, OperatorPhase::Done);
  EXPECT_NEAR(run.height_m, 0, kHeight_m);
}

TEST(Screw, TheHandleStaysWithinItsRange) {
  const Screwed run = screwOn({}, kNut);
  // The nut turns 2.6 rad back and 8.8 rad on; the first stroke is half the handle's range, and a stroke
  // after a change of direction is shorter.
  EXPECT_NEAR(run.grips, (2.6 - 0.7) / 1.4 + 8.8 / 1.4, 1.5);
  EXPECT_LT(run.farthest_rad, 0.7 + 0.1);  // 0.1 rad is the lag of the hand at 1.2 rad/s
  EXPECT_EQ(screwOn({}, {.pitch_m = 2e-3}).grips, 0);
}

TEST(Screw, WithoutADropItIsTriedAfterATurnAndAQuarter) {
  ThreadWorld world;
  world.drop_m = 0;
  world.play_m = 0;
  const Screwed run = screwOn(world, kNut, 120);
  EXPECT_LT(run.drop_rad, -1.2 * kTurn_rad);
}

TEST(Screw, WhatDoesNotCatchIsTurnedBackAndTriedAgainUntilTheTimeIsOver) {
  ThreadWorld smooth;
  smooth.along_share = 0;
  const Screwed run = screwOn(smooth, kNut);
  EXPECT_EQ(run.phase, OperatorPhase::Failed);
  EXPECT_GT(run.retries, 0);
  EXPECT_NE(std::find(run.strategies.begin(), run.strategies.end(), OperatorStrategy::BackOff),
            run.strategies.end());
}

TEST(Screw, ACrossedThreadIsNoThread) {
  for (const double share : {0.3, 1.7}) {
    ThreadWorld crossed;
    crossed.along_share = share;
    crossed.target_m = -6e-3;  // farther than the advance in the turn after which the hand decides
    const Screwed run = screwOn(crossed, kNut, 90);
    EXPECT_GT(run.retries, 0) << share;
  }
  for (const double share : {0.8, 1.2}) {  // within the play and the errors of the hand
    ThreadWorld worn;
    worn.along_share = share;
    EXPECT_EQ(screwOn(worn, kNut, 90).retries, 0) << share;
  }
}

}  // namespace
}  // namespace vps::device
