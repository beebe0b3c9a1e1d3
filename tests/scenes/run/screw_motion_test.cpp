// SPDX-License-Identifier: BSD-3-Clause
// Whether a part followed its thread, from poses that are given by formula.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "step/screw_motion.h"
#include "vps_device/operator.h"

namespace vps::scenes {
namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;
const Vec3 kDown(0, 0, -1);

struct Path {
  double turns = 2, advance_per_turn_m = 2e-3, lean_rad = 0;
  double side = 1;  ///< -1: turned in the other direction
};

/// Rows of a screw motion, after a first try of half a turn that must not count.
std::vector<TraceRow> rowsOf(const Path& path) {
  std::vector<TraceRow> rows;
  const auto add = [&](device::OperatorStrategy strategy, double turns, double share) {
    TraceRow row;
    row.strategy = static_cast<int>(strategy);
    const Vec3 lean = share * path.lean_rad * Vec3::UnitX();
    row.X_WP = {Mat3(rotationFromVector(lean) * rotationFromVector(path.side * turns * kTurn_rad * kDown)),
                Vec3(turns * path.advance_per_turn_m * kDown)};
    rows.push_back(row);
  };
  for (int i = 0; i <= 100; ++i) add(device::OperatorStrategy::ScrewOn, -0.5 + 0.005 * i, 0);
  add(device::OperatorStrategy::TurnBack, 0, 0);
  for (int i = 0; i <= 1000; ++i) add(device::OperatorStrategy::ScrewOn, path.turns * i / 1000, i / 1000.0);
  return rows;
}

SceneStep nutStep(double pitch_m = 2e-3) {
  SceneStep step;
  step.motion = StepMotion::Screw;
  step.pitch_m = pitch_m;
  step.X_WP_target = Pose::translation({0, 0, -4e-3});
  return step;
}

StepResult measured(const Path& path, const SceneStep& step = nutStep()) {
  StepResult result;
  result.strategies.push_back({"screw_on"});
  measureScrew(rowsOf(path), step, kDown, Pose(), result);
  return result;
}

std::string faultOf(const Path& path) {
  return threadFault(nutStep(), measured(path));
}

TEST(ScrewMotion, TurnsAdvanceAndLeanAreThoseOfTheLastTry) {
  const StepResult result = measured({.turns = 3, .advance_per_turn_m = 1.9e-3, .lean_rad = 0.01});
  EXPECT_NEAR(result.turns, 3, 1e-4);  // the error is quadratic in the lean
  EXPECT_NEAR(result.advance_per_turn_m, 1.9e-3, 1e-7);
  EXPECT_NEAR(result.lean_rad, 0.01, 1e-6);
}

TEST(ScrewMotion, AThreadIsFollowedWithinHalfItsPitch) {
  EXPECT_EQ(faultOf({.advance_per_turn_m = 2e-3}), "");
  EXPECT_EQ(faultOf({.advance_per_turn_m = 1.01e-3}), "");
  EXPECT_EQ(faultOf({.advance_per_turn_m = 2.99e-3}), "");
  EXPECT_NE(faultOf({.advance_per_turn_m = 0.99e-3}).find("did not catch"), std::string::npos);
  EXPECT_NE(faultOf({.advance_per_turn_m = 3.01e-3}).find("skipped"), std::string::npos);
}

TEST(ScrewMotion, APartThatLeansIsCrossedWhateverItsAdvance) {
  EXPECT_EQ(faultOf({.lean_rad = 0.034}), "");
  const std::string words = faultOf({.advance_per_turn_m = 1.8e-3, .lean_rad = 0.036});
  EXPECT_NE(words.find("crossed"), std::string::npos) << words;
  EXPECT_NE(words.find("1.80 mm a turn (pitch 2.00 mm)"), std::string::npos) << words;
  EXPECT_NE(words.find("2.1 degrees"), std::string::npos) << words;
}

TEST(ScrewMotion, HalfATurnIsNeededToTell) {
  EXPECT_EQ(faultOf({.turns = 0.51}), "");
  EXPECT_NE(faultOf({.turns = 0.49}).find("could not be screwed on"), std::string::npos);
  StepResult never;
  EXPECT_EQ(threadFault(nutStep(), never), "");  // a person moved the nut
  never.strategies.push_back({"place_by_sight"});
  EXPECT_NE(threadFault(nutStep(), never).find("never screwed on"), std::string::npos);
}

TEST(ScrewMotion, ALeftHandThreadCountsTheOtherTurn) {
  EXPECT_NEAR(measured({.side = -1}, nutStep(-2e-3)).turns, 2, 1e-6);
  EXPECT_NEAR(measured({.side = -1}).turns, -2, 1e-6);
}

TEST(ScrewMotion, TheTargetIsAHeight) {
  const SceneStep step = nutStep();
  const Pose X_PG = Pose::translation({0, 1e-3, 0});
  const Mat3 R = rotationFromVector(1.3 * kDown);
  // The part is rotated about the axis through G and is 0.2 mm too high.
  const Pose X_WP(R, Vec3(step.X_WP_target * X_PG.p - R * X_PG.p + Vec3(0, 0, 0.2e-3)));
  const Pose X_back = turnedBack(X_WP, step, kDown, X_PG);
  EXPECT_LT((X_back.p - Vec3(0, 0, -3.8e-3)).norm(), 1e-12);
  EXPECT_LT(rotationVector(X_back.R).norm(), 1e-12);
}

}  // namespace
}  // namespace vps::scenes
