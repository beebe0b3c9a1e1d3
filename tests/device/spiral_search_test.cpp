// SPDX-License-Identifier: BSD-3-Clause
// The spiral search on a part that friction holds.
#include <gtest/gtest.h>

#include <algorithm>

#include "operator/strategies/strategy.h"

namespace vps::device {
namespace {

constexpr double kDt_s = 1e-3;

/// A part that is coupled to the hand by a spring, pressed on a plane with Coulomb's friction: it follows the
/// hand up to friction / spring behind.
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

/// How far the part goes from where it began, until the search ends.
double reachOfSearch(double friction_N) {
  Situation situation;
  SlidingPart sliding;
  sliding.friction_N = friction_N;
  const std::unique_ptr<Strategy> search = makeSpiralSearch();
  search->start(situation, sliding.feel(0, situation.habits.search_N));
  double farthest_m = 0;
  Outcome outcome = Outcome::GoingOn;
  for (double t_s = 0; outcome == Outcome::GoingOn && t_s < 60; t_s += kDt_s) {
    outcome = search->step(sliding.feel(t_s, situation.habits.search_N), kDt_s);
    sliding.moveHand(search->move().across_m);
    farthest_m = std::max(farthest_m, sliding.part_m.norm());
  }
  EXPECT_EQ(outcome, Outcome::Failed);  // there is no hole
  return farthest_m;
}

// A friction of 0.5 N behind a spring of 1 kN/m is as far as the whole spiral: a hand that does not lead the
// part moves it nowhere.
TEST(SpiralSearch, LeadsAPartThatFrictionHolds) {
  const double limit_m = OperatorHabits().search_limit_m;
  for (const double friction_N : {0.0, 0.2, 0.5}) {
    EXPECT_GT(reachOfSearch(friction_N), 0.8 * limit_m) << friction_N << " N";
    EXPECT_LT(reachOfSearch(friction_N), 1.5 * limit_m) << friction_N << " N";
  }
}

// It was backed off before its hole, and sight has moved it above the hole since: it drops while it is
// lowered, past where it touched before. There is nothing to search for then.
TEST(SpiralSearch, EndsWhereThePartDropsWhileItIsLowered) {
  Situation situation;
  situation.mouth_m = -14e-3;
  Feel feel;
  feel.along_m = situation.mouth_m - situation.habits.back_off_m;
  const std::unique_ptr<Strategy> search = makeSpiralSearch();
  search->start(situation, feel);
  Outcome outcome = Outcome::GoingOn;
  for (; outcome == Outcome::GoingOn && feel.time_s < 10; feel.time_s += kDt_s) {
    outcome = search->step(feel, kDt_s);
    feel.along_m = std::min(0.0, feel.along_m + 10e-3 * kDt_s);
    feel.resist_N = feel.along_m < 0 ? 0 : situation.habits.search_N;
  }
  EXPECT_EQ(outcome, Outcome::Done);
  EXPECT_LT(feel.along_m, situation.mouth_m + 1e-3);
}

}  // namespace
}  // namespace vps::device
