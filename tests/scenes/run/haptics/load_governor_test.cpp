// SPDX-License-Identifier: BSD-3-Clause
#include "load/load_governor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace vps::scenes {
namespace {

constexpr double kPeriod_s = 1e-3, kMostLate_s = 0.02;

/// Six levels below level 0, each with half the cost of the level above.
LoadGovernor halving() {
  return LoadGovernor(std::vector<double>(6, 2.0));
}

/// A load of load(t) periods a step at level 0, and half as much with each level.
struct Course {
  std::vector<int> levels;  ///< level after each change
  std::vector<double> times_s;
};
/// Like PhysicsClock: late steps follow at once, up to a delay of 20 ms.
Course follow(LoadGovernor& governor, double seconds, const std::function<double(double)>& load,
              bool may_rise = true) {
  Course course;
  double due_s = 0;
  for (double time_s = 0; time_s < seconds;) {
    const int before = governor.level();
    const double busy_s = load(time_s) * kPeriod_s * std::pow(0.5, before);
    due_s += kPeriod_s;
    time_s = std::max(time_s + busy_s, due_s);
    if (time_s - due_s > kMostLate_s)
      due_s += kPeriod_s * std::ceil((time_s - due_s - kMostLate_s) / kPeriod_s);
    if (governor.add(busy_s, kPeriod_s, may_rise) == before) continue;
    course.levels.push_back(governor.level());
    course.times_s.push_back(time_s);
  }
  return course;
}

TEST(LoadGovernor, ALoadThatFitsChangesNothing) {
  LoadGovernor governor = halving();
  EXPECT_TRUE(follow(governor, 20, [](double) { return 0.99; }).levels.empty());
  EXPECT_EQ(governor.last().lost_s, 0);
}

TEST(LoadGovernor, OneLateStepInAWindowChangesNothingHoweverLate) {
  LoadGovernor governor = halving();
  int step = 0;
  const Course course = follow(governor, 20, [&](double) { return ++step % 200 == 0 ? 500.0 : 0.1; });
  EXPECT_TRUE(course.levels.empty());
  EXPECT_GT(governor.last().lostShare(), 0.5) << "the load must be above the limit";
  EXPECT_FALSE(governor.isOverloaded());
}

// One step in ten takes nine periods and the others a twentieth of one, 0.945 on average; or a fifth of
// one, 1.08 on average.
TEST(LoadGovernor, LateStepsThatAreMadeUpForChangeNothing) {
  for (const double others : {0.05, 0.2}) {
    LoadGovernor governor = halving();
    int step = 0;
    (void)follow(governor, 2, [&](double) { return ++step % 10 == 0 ? 9.0 : others; });
    EXPECT_EQ(governor.level(), others < 0.1 ? 0 : 1) << others;
  }
}

// Steps of 1.04 periods lose 4 % of the time, and steps of 1.1 periods lose 9 %.
TEST(LoadGovernor, LateStepsCountByTheTimeTheyLose) {
  for (const double load : {1.04, 1.1}) {
    LoadGovernor governor = halving();
    (void)follow(governor, 2, [&](double) { return load; });
    EXPECT_EQ(governor.level(), load > 1.05 ? 1 : 0) << load;
  }
}

// Steps of 5 periods take 2.5, 1.25 and 0.625 periods at levels 1, 2 and 3. A window is 0.25 s; its last step
// may end up to 5 ms later, and 20 ms of delay are made up for.
TEST(LoadGovernor, ALoadThatDoesNotFitGoesDownLevelByLevelAndStaysWhereItFits) {
  LoadGovernor governor = halving();
  const Course course = follow(governor, 20, [](double) { return 5.0; });
  EXPECT_EQ(course.levels, (std::vector<int>{1, 2, 3}));
  for (std::size_t i = 0; i < course.times_s.size(); ++i)
    EXPECT_NEAR(course.times_s[i], 0.25 * static_cast<double>(i + 1),
                kMostLate_s + 5e-3 * static_cast<double>(i + 1));
  EXPECT_EQ(governor.last().lost_s, 0);
  EXPECT_NEAR(governor.last().busy_s, 5e-3 / 8, 1e-12);
}

TEST(LoadGovernor, ALoadThatNoLevelCanCarryEndsAtTheLastLevelAsOverloaded) {
  LoadGovernor governor = halving();
  const Course course = follow(governor, 20, [](double) { return 1000.0; });
  EXPECT_EQ(course.levels, (std::vector<int>{1, 2, 3, 4, 5, 6}));
  EXPECT_TRUE(governor.isOverloaded());
}

// At half speed, half of the time is lost, which is worse than losing a fifth and better than losing three
// fifths. Steps of 1.25 periods lose a fifth, of 2.5 periods three fifths.
TEST(LoadGovernor, TimeIsSlowedOnlyWhereMoreOfItIsLost) {
  for (const bool is_heavy : {false, true}) {
    LoadGovernor governor({2.0}, {}, {1, 0.5});
    (void)follow(governor, 3, [&](double) { return is_heavy ? 2.5 : 1.25; });
    EXPECT_EQ(governor.level(), is_heavy ? 1 : 0);
    EXPECT_TRUE(is_heavy || governor.isOverloaded()) << "the load must be above the limit";
  }
}

// The governor goes up after 8 windows of 0.25 s in which the level above would have been sufficient.
TEST(LoadGovernor, AfterTheLoadEndsItGoesUpByOneLevelEveryTwoSeconds) {
  LoadGovernor governor = halving();
  const Course course = follow(governor, 20, [](double time_s) { return time_s < 1 ? 5.0 : 0.1; });
  EXPECT_EQ(course.levels, (std::vector<int>{1, 2, 3, 2, 1, 0}));
  for (std::size_t i = 4; i < course.times_s.size(); ++i)
    EXPECT_NEAR(course.times_s[i] - course.times_s[i - 1], 2, 0.01);
}

TEST(LoadGovernor, StallsDoNotKeepItFromGoingUp) {
  LoadGovernor governor = halving();
  int step = 0;
  const Course course = follow(governor, 8, [&](double time_s) {
    return time_s < 0.3 ? 1.5 : ++step % 100 == 0 ? 40.0 : 0.1;
  });
  EXPECT_EQ(course.levels, (std::vector<int>{1, 0}));
}

// At level 1 these steps take 0.55 periods; at level 0 they would take 1.1, so the governor must stay at
// level 1.
TEST(LoadGovernor, ItDoesNotGoUpWhereTheLoadWouldNotFit) {
  LoadGovernor governor = halving();
  EXPECT_EQ(follow(governor, 60, [](double) { return 1.1; }).levels, (std::vector<int>{1}));
}

// Two seconds of load, three without, for ten minutes: 120 times. Each relapse doubles the wait: 2, 4, 8, 16,
// 32, 64 s; with pauses of 3 s only the first wait of 2 s can end.
TEST(LoadGovernor, ALoadThatComesAndGoesDoesNotMakeItOscillate) {
  LoadGovernor governor = halving();
  const Course course =
      follow(governor, 600, [](double time_s) { return std::fmod(time_s, 5) < 2 ? 1.5 : 0.1; });
  EXPECT_EQ(course.levels, (std::vector<int>{1, 0, 1}));
}

TEST(LoadGovernor, AFailedChangeUpwardsIsTriedAgainAfterTwiceTheTime) {
  LoadGovernor governor = halving();
  follow(governor, 1, [](double) { return 3.0; });
  const int before = governor.level();
  ASSERT_EQ(before, 2);
  const double first_s = follow(governor, 2.5, [](double) { return 0.1; }).times_s.at(0);
  EXPECT_EQ(governor.level(), 1);
  governor.stayAt(before);
  EXPECT_EQ(governor.level(), 2);
  const Course again = follow(governor, 4.2, [](double) { return 0.1; });
  ASSERT_EQ(again.levels, std::vector<int>{1});
  EXPECT_NEAR(again.times_s[0], 4, 0.3) << "sixteen windows of a quarter of a second, after " << first_s;
}

TEST(LoadGovernor, ALevelThatMayNotRiseNowRisesAsSoonAsItMay) {
  LoadGovernor governor = halving();
  (void)follow(governor, 0.3, [](double) { return 1.5; });
  ASSERT_EQ(governor.level(), 1);
  EXPECT_TRUE(follow(
                  governor, 30, [](double) { return 0.1; }, false)
                  .levels.empty());
  const Course course = follow(governor, 1, [](double) { return 0.1; });
  ASSERT_EQ(course.levels, (std::vector<int>{0}));
  EXPECT_LE(course.times_s[0], 0.25 + 1e-9) << "at the end of the first window";
}

TEST(LoadGovernor, DurationsThatAreNotNumbersAreNoLoad) {
  LoadGovernor governor = halving();
  for (const double busy_s : {std::numeric_limits<double>::quiet_NaN(), -1.0})
    for (int i = 0; i < 2000; ++i) ASSERT_EQ(governor.add(busy_s, kPeriod_s), 0);
  for (int i = 0; i < 4; ++i)  // four jumps of the clock: fewer than five late steps in a window
    EXPECT_EQ(governor.add(std::numeric_limits<double>::infinity(), kPeriod_s), 0);
  EXPECT_TRUE(std::isfinite(governor.last().elapsed_s));
}

}  // namespace
}  // namespace vps::scenes
