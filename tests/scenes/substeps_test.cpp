// SPDX-License-Identifier: BSD-3-Clause
// Parts that turn farther in a step than it can hold: what is said of them, and steps that are divided.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/scene_part.h"
#include "vps_scenes/simulate.h"

namespace vps::scenes {
namespace {

constexpr double kMm = 1e-3, kRpm = std::numbers::pi / 30;

/// Without gravity and friction: a shaft in a bore, or alone.
Scene shaftScene(double rpm, bool is_in_bore) {
  Scene scene;
  scene.file = scene.name = "shaft";
  scene.gravity_W = Vec3::Zero();
  scene.parts = {scenePart("shaft", makeCylinder(5 * kMm, 10 * kMm, 64), Vec3::Zero(), false)};
  if (is_in_bore)
    scene.parts.push_back(scenePart("bore", makeTube(8 * kMm, 5.03 * kMm, 6 * kMm, 64), Vec3::Zero(), true));
  for (ScenePart& part : scene.parts) part.part.material.friction = 0;
  scene.parts[0].V_WP_W.w = {0, 0, rpm * kRpm};
  return scene;
}

TEST(Substeps, APartThatTurnsTooFastIsNamedOnceWithWhatHoldsIt) {
  for (const bool is_in_bore : {false, true}) {
    Scene scene = shaftScene(10'000, is_in_bore);
    const SimulateResult result = simulate(scene, 0.02);
    ASSERT_EQ(result.fast_turns.size(), 1U);
    const FastTurn& turn = result.fast_turns[0];
    EXPECT_EQ(turn.part, "shaft");
    EXPECT_EQ(turn.is_in_contact, is_in_bore);
    EXPECT_NEAR(turn.w_rad_s, 10'000 * kRpm, 1);
    EXPECT_NEAR(turn.turn_rad, 1.047, 0.001);
    const std::string words = inWords(turn);
    EXPECT_NE(words.find("'shaft' turns"), std::string::npos) << words;
    EXPECT_NE(words.find("10000 rpm"), std::string::npos) << words;
    // At the rate that it states nothing is said any more.
    Scene fine = shaftScene(10'000, is_in_bore);
    fine.fidelity.physics_rate_hz = std::ceil(turn.needed_hz) + 1;
    EXPECT_TRUE(simulate(fine, 0.02).fast_turns.empty());
  }
}

TEST(Substeps, NothingIsSaidOfAPartThatAStepHolds) {
  Scene scene = shaftScene(900, true);  // 0.094 rad in a step
  const SimulateResult result = simulate(scene, 0.02);
  EXPECT_TRUE(result.fast_turns.empty());
  EXPECT_EQ(result.most_substeps, 1);
}

TEST(Substeps, AutoDividesTheStepsAndKeepsTheSpeed) {
  for (const bool is_in_bore : {false, true}) {
    Scene scene = shaftScene(10'000, is_in_bore);
    scene.fidelity.substeps = 0;
    const SimulateResult result = simulate(scene, 0.05);
    EXPECT_TRUE(result.fast_turns.empty());
    EXPECT_EQ(result.most_substeps, is_in_bore ? 11 : 2);
    EXPECT_NEAR(result.bodies[0].V_WP_W.w.z(), 10'000 * kRpm, 1);
  }
}

TEST(Substeps, AutoChangesNoBitWhereNoStepNeedsIt) {
  Scene whole = shaftScene(500, true), divided = shaftScene(500, true);
  divided.fidelity.substeps = 0;
  const SimulateResult a = simulate(whole, 0.05), b = simulate(divided, 0.05);
  EXPECT_EQ(a.bodies[0].X_WP.p, b.bodies[0].X_WP.p);
  EXPECT_EQ(a.bodies[0].X_WP.R, b.bodies[0].X_WP.R);
}

// As many steps of a tenth of the length.
TEST(Substeps, ANumberOfThemIsTheSameAsAHigherRate) {
  Scene divided = shaftScene(2000, true), fast = shaftScene(2000, true);
  divided.fidelity.substeps = 8;
  fast.fidelity.physics_rate_hz = 8000;
  const SimulateResult a = simulate(divided, 0.02), b = simulate(fast, 0.02);
  EXPECT_EQ(a.bodies[0].X_WP.p, b.bodies[0].X_WP.p);
  EXPECT_EQ(a.bodies[0].X_WP.R, b.bodies[0].X_WP.R);
  EXPECT_EQ(a.step.count * 8, b.step.count);
}

}  // namespace
}  // namespace vps::scenes
