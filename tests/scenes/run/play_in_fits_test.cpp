// SPDX-License-Identifier: BSD-3-Clause
// How far a part may lean in its fits, by the formula, and where a part belongs whose mate is displaced.
#include "world/play_in_fits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/scene_part.h"
#include "support/lathe.h"
#include "vps_scenes/run/assemble.h"

namespace vps::scenes {
namespace {

constexpr int kFitFlats = 192;
constexpr double kShaft_m = 5e-3, kHole_m = 5.025e-3, kOuter_m = 10e-3;
constexpr double kClearance_m = 2 * (kHole_m - kShaft_m);

DrawnPart drawn(const std::string& name, const Mesh& mesh, const Vec3& p_WP) {
  DrawnPart part;
  part.name = name;
  part.mesh = mesh;
  part.X_WP = Pose::translation(p_WP);
  return part;
}

Mesh ring(double length_m) {
  return test::lathe({{kHole_m, 0}, {kOuter_m, 0}, {kOuter_m, length_m}, {kHole_m, length_m}}, kFitFlats);
}

DrawnPart shaft() {
  return drawn("shaft", test::lathe({{0, 0}, {kShaft_m, 0}, {kShaft_m, 60e-3}, {0, 60e-3}}, kFitFlats),
               Vec3::Zero());
}

TEST(LeanInFits, AShortRingLeansByItsClearanceOverItsLength) {
  constexpr double kLength_m = 3e-3;
  const double reach_m = std::hypot(kOuter_m, kLength_m / 2);
  const double expected_m = kClearance_m * reach_m / kLength_m;  // 169 um
  EXPECT_NEAR(leanInFits_m(drawn("ring", ring(kLength_m), {0, 0, 30e-3}), {shaft()}), expected_m,
              0.02 * expected_m);
}

TEST(LeanInFits, ALongRingIsOffByHalfItsClearance) {
  constexpr double kLength_m = 40e-3;
  const double expected_m = kClearance_m * std::hypot(kOuter_m, kLength_m / 2) / kLength_m;  // 28 um
  EXPECT_GT(expected_m, kClearance_m / 2);
  EXPECT_NEAR(leanInFits_m(drawn("ring", ring(kLength_m), {0, 0, 10e-3}), {shaft()}), expected_m,
              0.02 * expected_m);
}

// Two fits of 3 mm, 30 mm from end to end.
TEST(LeanInFits, TwoShortFitsHoldAsOneLongOne) {
  const double alone_m = leanInFits_m(shaft(), {drawn("low", ring(3e-3), {0, 0, 15e-3})});
  const double both_m = leanInFits_m(
      shaft(), {drawn("low", ring(3e-3), {0, 0, 15e-3}), drawn("high", ring(3e-3), {0, 0, 42e-3})});
  EXPECT_NEAR(both_m, kClearance_m * std::hypot(kShaft_m, 30e-3) / 30e-3, 0.02 * both_m);
  EXPECT_GT(alone_m, 10 * both_m);
}

TEST(LeanInFits, APartWithoutAFitHasNoLean) {
  EXPECT_EQ(leanInFits_m(shaft(), {}), 0);
}

Mesh ringOf(double hole_m, double outer_m, double length_m) {
  return test::lathe({{hole_m, 0}, {outer_m, 0}, {outer_m, length_m}, {hole_m, length_m}}, kFitFlats);
}

/// A part that lies along x, starting at its origin.
ScenePart lying(const std::string& name, const Mesh& mesh, double x_m, bool is_fixed) {
  ScenePart part = scenePart(name, mesh, {x_m, 0, 0}, is_fixed);
  part.X_WP.R = rotationFromVector(Vec3(0, std::numbers::pi / 2, 0));
  return part;
}

/// A wall with a level hole, an axle in it with a flange, and a collar on the axle, each with 0.1 mm of play.
Scene collarOnAxle() {
  Scene scene;
  scene.file = scene.name = "axle";
  scene.parts = {
      lying("wall", ringOf(8.05e-3, 30e-3, 20e-3), 0, true),
      lying("axle",
            test::lathe({{0, -6e-3}, {20e-3, -6e-3}, {20e-3, 0}, {8e-3, 0}, {8e-3, 45e-3}, {0, 45e-3}},
                        kFitFlats),
            0, false),
      lying("collar", ringOf(8.05e-3, 15e-3, 10e-3), 20e-3, false)};
  for (const std::size_t part : {1u, 2u}) {
    SceneStep step;
    step.part = part;
    step.X_WP_target = step.X_WP_start = scene.parts[part].X_WP;
    step.X_WP_start.p.x() += part == 1 ? -55e-3 : 30e-3;
    step.timeout_s = 40;
    scene.steps.push_back(step);
  }
  return scene;
}

TEST(DisplacedMates, AreThoseThatWereMovedAndFit) {
  const Scene scene = collarOnAxle();
  std::vector<Pose> X_WP;
  for (const ScenePart& part : scene.parts) X_WP.push_back(part.X_WP);
  const Vec3 down_m(0, 0, -50e-6);
  X_WP[1].p += down_m;
  X_WP[0].p += Vec3(0, 1e-3, 0);  // the wall is fixed, so its pose does not count
  const std::vector<Vec3> by_m = displacedMates_m(scene, 1, X_WP);
  ASSERT_EQ(by_m.size(), 1U);
  EXPECT_LT((by_m[0] - down_m).norm(), 1e-9);
  EXPECT_TRUE(displacedMates_m(scene, 0, X_WP).empty());
}

TEST(DisplacedMates, AShaftPassesOnNothingAlongItsAxis) {
  const Scene scene = collarOnAxle();
  std::vector<Pose> X_WP;
  for (const ScenePart& part : scene.parts) X_WP.push_back(part.X_WP);
  const Vec3 down_m(0, 0, -50e-6), along_m(-0.4e-3, 0, 0);
  X_WP[1].p += down_m + along_m;
  const std::vector<Vec3> by_m = displacedMates_m(scene, 1, X_WP);
  ASSERT_EQ(by_m.size(), 2U);
  EXPECT_LT((by_m[0] - down_m).norm(), 1e-9);
  EXPECT_LT((by_m[1] - down_m - along_m).norm(), 1e-9);  // the collar may rest on the axle's shoulder
}

// The axle hangs 50 um low in its hole, and the collar hangs 50 um low on the axle: together 100 um, the
// tolerance of the collar's fit alone.
TEST(DisplacedMates, ACollarOnAnAxleThatHangsInItsHoleIsInPlace) {
  Scene scene = collarOnAxle();
  const AssembleResult result = assemble(scene);
  ASSERT_EQ(result.steps.size(), 2U);
  for (const StepResult& step : result.steps)
    EXPECT_EQ(step.verdict, Verdict::Fits) << step.part << ": " << step.reason;
  EXPECT_GT(result.steps[1].final_error_m, 95e-6);
  EXPECT_LE(result.steps[1].tolerance_m, 155e-6);
}

}  // namespace
}  // namespace vps::scenes
