// SPDX-License-Identifier: BSD-3-Clause
#include "query/motion/motion_tube.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "support/random_draw.h"

namespace vps {
namespace {

double distanceFromSegment(const Vec3& p, const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  const double square = way.squaredNorm();
  const double share = square > 0 ? std::clamp((p - from).dot(way) / square, 0.0, 1.0) : 0;
  return (p - from - share * way).norm();
}

// Lists of near pairs rely on this: between two poses that the tube holds, each point of a part that is near
// the other part is within the margin of its straight line, in the frame of either part.
TEST(MotionTube, PointsOfMotionsThatItHoldsStayWithinItsMargin) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1), size(1e-3, 20e-3);
  int held = 0;
  double fullest = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Ball ball0{size(random) * test::drawnDirection(random), size(random)},
        ball1{size(random) * test::drawnDirection(random), size(random)};
    const double radius_m = std::min(ball0.radius_m, ball1.radius_m);
    const Pose start(rotationFromVector(std::numbers::pi * unit(random) * test::drawnDirection(random)),
                     size(random) * test::drawnDirection(random));
    const double step_m = std::pow(10.0, -6 + 3 * unit(random));
    const Pose step(
        rotationFromVector(std::min(0.1, step_m / radius_m) * unit(random) * test::drawnDirection(random)),
        step_m * test::drawnDirection(random));
    const Pose end = start * step;
    const MotionTube tube(ball0, ball1, start, end);
    ASSERT_TRUE(tube.holds(start));
    ASSERT_TRUE(tube.holds(end)) << trial;
    // A place on the expected motion, and off it.
    const MotionBetweenPoses way(ball0, ball1, tube.from(), tube.to());
    const double off_m = 1.5 * tube.margin_m() * unit(random);
    Pose X[2];
    for (Pose& pose : X) {
      const Pose on = way.at(unit(random)).inverse();
      pose = on * Pose(rotationFromVector(off_m / radius_m * unit(random) * test::drawnDirection(random)),
                       off_m * unit(random) * test::drawnDirection(random));
    }
    if (!tube.holds(X[0]) || !tube.holds(X[1])) continue;
    ++held;
    const bool is_first = ball0.radius_m <= ball1.radius_m;
    const Ball& smaller = is_first ? ball0 : ball1;
    const MotionBetweenPoses between(ball0, ball1, X[0], X[1]);
    for (int k = 0; k < 20; ++k) {
      const Pose at_10 = between.at(unit(random));
      const Vec3 own = smaller.center + smaller.radius_m * test::drawnDirection(random);
      // The point in its own part's frame, and its place in the other part's frame.
      const Vec3 p0 = is_first ? own : Vec3(at_10.inverse() * own), p1 = is_first ? Vec3(at_10 * own) : own;
      const double of_0_m = distanceFromSegment(p1, tube.from().inverse() * p0, tube.to().inverse() * p0);
      const double of_1_m = distanceFromSegment(p0, tube.from() * p1, tube.to() * p1);
      ASSERT_LE(of_0_m, tube.margin_m() * (1 + 1e-9)) << trial;
      ASSERT_LE(of_1_m, tube.margin_m() * (1 + 1e-9)) << trial;
      fullest = std::max(fullest, std::max(of_0_m, of_1_m) / tube.margin_m());
    }
  }
  EXPECT_GT(held, 500);
  EXPECT_GT(fullest, 0.5);  // otherwise the tube would be too wide
}

TEST(MotionTube, DoesNotHoldWhatLeavesIt) {
  const Ball ball{Vec3::Zero(), 10e-3};
  const Pose start = Pose::translation({20e-3, 0, 0}), end = Pose::translation({20e-3, 0.1e-3, 0});
  const MotionTube tube(ball, ball, start, end);
  EXPECT_TRUE(tube.holds(Pose::translation({20e-3, 0.2e-3, 0})));
  EXPECT_FALSE(tube.holds(Pose::translation({20e-3, -0.1e-3, 0})));
  EXPECT_FALSE(tube.holds(Pose::translation({19.9e-3, 0.1e-3, 0})));
  EXPECT_FALSE(tube.holds(Pose(rotationFromVector({0, 0, 0.01}), Vec3(20e-3, 0.1e-3, 0))));
  EXPECT_FALSE(tube.holds(Pose::translation({20e-3, 10e-3, 0})));
}

// A nut moves in steps of 40 um. In each step the nut is expected to fall by another 10 um, which the thread
// prevents.
TEST(MotionTube, FollowsTheMotionThatThePartsHad) {
  const Ball ball{Vec3::Zero(), 10e-3};
  const auto at = [](double way_m, double fall_m) { return Pose::translation({20e-3, way_m, -fall_m}); };
  const Pose last = at(-40e-6, 0), start = at(0, 0), end = at(40e-6, 10e-6), later = at(320e-6, 0);
  EXPECT_FALSE(MotionTube(ball, ball, start, end).holds(later));
  const MotionTube tube = MotionTube::following(ball, ball, last, start, end, 1);
  for (const Pose& X : {start, end, later}) EXPECT_TRUE(tube.holds(X));
  // If the parts were far away before, or did not move, the step's own motion is expected.
  for (const Pose& before : {at(0.5e-3, 0), start}) {
    const MotionTube other = MotionTube::following(ball, ball, before, start, end, 1);
    for (const Pose& X : {start, end}) EXPECT_TRUE(other.holds(X));
    EXPECT_FALSE(other.holds(later));
  }
}

}  // namespace
}  // namespace vps
