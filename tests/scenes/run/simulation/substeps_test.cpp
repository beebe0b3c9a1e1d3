// SPDX-License-Identifier: BSD-3-Clause
// Parts that turn in a step by more than the limit: their reports, and steps that are divided.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/scene_models.h"
#include "scenes/scene_part.h"
#include "simulation/simulation.h"
#include "support/units.h"
#include "vps_scenes/run/simulate.h"

namespace vps::scenes {
namespace {

constexpr double kRpm = std::numbers::pi / 30;

/// A shaft in a bore, or alone, without gravity and friction. A bore of 5.03 mm leaves clearance at any
/// angle; in a bore of 5.0064 mm and 64 sides, the corners of the shaft pass the sides at 0.4 um.
Scene shaftScene(double rpm, bool is_in_bore, double bore_m = 5.03 * kMm) {
  Scene scene;
  scene.file = scene.name = "shaft";
  scene.gravity_W = Vec3::Zero();
  scene.parts = {scenePart("shaft", makeCylinder(5 * kMm, 10 * kMm, 64), Vec3::Zero(), false)};
  if (is_in_bore)
    scene.parts.push_back(scenePart("bore", makeTube(8 * kMm, bore_m, 6 * kMm, 64), Vec3::Zero(), true));
  for (ScenePart& part : scene.parts) part.part.material.friction = 0;
  scene.parts[0].V_WP_W.w = {0, 0, rpm * kRpm};
  return scene;
}

TEST(Substeps, APartThatTurnsTooFastIsNamedOnceWithWhatHoldsIt) {
  for (const bool is_in_bore : {false, true}) {
    Scene scene = shaftScene(10'000, is_in_bore, 5.0064 * kMm);
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
    // At the rate that the report states, nothing is reported.
    Scene fine = shaftScene(10'000, is_in_bore, 5.0064 * kMm);
    fine.fidelity.physics_rate_hz = std::ceil(turn.needed_hz) + 1;
    EXPECT_TRUE(simulate(fine, 0.02).fast_turns.empty());
  }
}

TEST(Substeps, AShaftWithRoomAroundItDoesNotTouchWhatItTurnsIn) {
  Scene at_3000 = shaftScene(3000, true), at_10000 = shaftScene(10'000, true);
  EXPECT_TRUE(simulate(at_3000, 0.02).fast_turns.empty());  // 0.31 rad in a step
  const SimulateResult faster = simulate(at_10000, 0.02);   // 1.05 rad: Bullet turns the shaft by less
  ASSERT_EQ(faster.fast_turns.size(), 1U);
  EXPECT_FALSE(faster.fast_turns[0].is_in_contact);
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

// Ten times as many steps of a tenth of the length.
TEST(Substeps, ANumberOfThemIsTheSameAsAHigherRate) {
  Scene divided = shaftScene(2000, true), fast = shaftScene(2000, true);
  divided.fidelity.substeps = 8;
  fast.fidelity.physics_rate_hz = 8000;
  const SimulateResult a = simulate(divided, 0.02), b = simulate(fast, 0.02);
  EXPECT_EQ(a.bodies[0].X_WP.p, b.bodies[0].X_WP.p);
  EXPECT_EQ(a.bodies[0].X_WP.R, b.bodies[0].X_WP.R);
  EXPECT_EQ(a.step.count * 8, b.step.count);
}

// The judge receives the poses after each substep, since the motion between the ends of a whole step would be
// unknown.
TEST(Substeps, EachPartOfAStepIsShown) {
  Scene scene = shaftScene(60'000, false);  // a whole turn in a step
  scene.fidelity.substeps = 0;
  const ModelPlan plan = makeModelPlan(scene, ModelPurpose::Simulate);
  buildModels(scene, plan, {});
  Simulation simulation(scene, plan);
  simulation.addBody(0, Pose());
  simulation.setTwist(0, scene.parts[0].V_WP_W);
  int shown = 0, count = 0;
  double least_x = 1;
  simulation.step(1e-3, [&](int number, int parts) {
    EXPECT_EQ(number, ++shown);
    count = parts;
    least_x = std::min(least_x, simulation.pose(0).R(0, 0));
  });
  EXPECT_EQ(shown, count);
  EXPECT_GE(count, 8);  // parts of 0.785 rad at most
  EXPECT_LT(least_x, -0.9);
  EXPECT_GT(simulation.pose(0).R(0, 0), 0.99);
}

// A cube that tips over turns fast for a moment, about the edge that it rests on.
TEST(Substeps, NothingIsSaidOfACubeThatTipsOver) {
  Scene scene;
  scene.file = scene.name = "cube";
  scene.parts = {scenePart("plate", makeBox({80 * kMm, 80 * kMm, 10 * kMm}), {0, 0, -5 * kMm}, true),
                 scenePart("cube", makeBox({20 * kMm, 20 * kMm, 20 * kMm}), {0, 0, 37 * kMm}, false)};
  scene.parts[1].X_WP.R = rotationFromVector(Vec3(0.6, 0.3, 0));
  scene.parts[1].V_WP_W.w = {8, 0, 0};
  scene.fidelity.physics_rate_hz = 240;
  EXPECT_TRUE(simulate(scene, 0.4).fast_turns.empty());
}

TEST(Substeps, TheWorstPartIsNamedAndTheOthersAreCounted) {
  const FastTurn slow{"slow", true, 200, 0.2, 0.1, 2000}, fast{"fast", true, 400, 0.4, 0.1, 4000};
  Fidelity fidelity;
  const std::string words = inWords({slow, fast, slow}, fidelity);
  EXPECT_NE(words.find("'fast' turns"), std::string::npos) << words;
  EXPECT_NE(words.find("and 2 other parts"), std::string::npos) << words;
  EXPECT_NE(words.find("\"auto\""), std::string::npos) << words;
  fidelity.substeps = 0;  // resolved already
  EXPECT_EQ(inWords({slow, fast}, fidelity).find("\"auto\""), std::string::npos);
  EXPECT_EQ(inWords(std::vector<FastTurn>(), fidelity), "");
}

}  // namespace
}  // namespace vps::scenes
