// SPDX-License-Identifier: BSD-3-Clause
// Disassembly runs whose answer is known by construction.
#include "support/units.h"
#include "vps_scenes/run/derived_scenes.h"

#include <gtest/gtest.h>

#include <numbers>

#include "scenes/peg_in_cup.h"
#include "support/recorded.h"
#include "support/temporary_folder.h"
#include "vps/errors.h"
#include "vps_scenes/run/assemble.h"
#include "vps_scenes/run/replay.h"

namespace vps::scenes {
namespace {

/// A plate that covers the peg's hole in the cup and is mounted from the side.
SceneStep lidStep(Scene& scene) {
  const PegInCup shape;
  scene.parts.push_back(scenePart("lid", makeBox({24 * kMm, 24 * kMm, 2 * kMm}),
                                  {0, 0, shape.length_m - shape.depth_m + 1 * kMm}, false));
  SceneStep step;
  step.part = 2;
  step.X_WP_target = scene.parts[2].X_WP;
  step.X_WP_start = step.X_WP_target;
  step.X_WP_start.p.x() += 40 * kMm;
  step.way_points = {step.X_WP_target};
  step.way_points[0].p.x() += 20 * kMm;
  step.is_held = true;  // the lid lies on the peg's end
  step.timeout_s = 10;
  return step;
}

TEST(Disassembly, APegLeavesItsCupByContact) {
  Scene scene = disassemblyOf(pegInCup({}));
  const AssembleResult result = assemble(scene);
  ASSERT_EQ(result.steps.size(), 1U);
  const StepResult& step = result.steps[0];
  EXPECT_EQ(result.verdict, Verdict::Fits) << step.reason;
  EXPECT_TRUE(step.is_taken_off);
  EXPECT_LE(step.max_penetration_m, step.penetration_limit_m);
  // The path is 11 mm long, and a quarter of that exceeds kAway_m.
  EXPECT_DOUBLE_EQ(step.tolerance_m, kAway_m);
  EXPECT_GT(result.finished.bodies[1].X_WP.p.z(), pegInCup({}).steps[0].X_WP_start.p.z() - kAway_m);
  // After the step, the part blocks no other part, and snapshots do not show it in place.
  EXPECT_EQ(result.finished.bodies[1].role, BodyRole::Waiting);
}

TEST(Disassembly, ThePartsComeOffInReverseAndAreThenInNobodysWay) {
  Scene scene = pegInCup({});
  scene.steps.push_back(lidStep(scene));
  scene = disassemblyOf(std::move(scene));
  const AssembleResult result = assemble(scene);
  ASSERT_EQ(result.steps.size(), 2U);
  EXPECT_EQ(result.steps[0].part, "lid");
  EXPECT_EQ(result.steps[1].part, "peg");
  EXPECT_EQ(result.verdict, Verdict::Fits) << result.steps[0].reason << result.steps[1].reason;
}

TEST(Disassembly, APegUnderALidThatIsStillThereDoesNotComeOff) {
  Scene scene = pegInCup({});
  scene.steps.insert(scene.steps.begin(), lidStep(scene));  // so that the peg is taken off first
  scene.steps[1].timeout_s = 4;
  scene = disassemblyOf(std::move(scene));
  AssembleOptions options;
  options.keep_going = false;
  const AssembleResult result = assemble(scene, options);
  ASSERT_EQ(result.steps.size(), 1U);
  EXPECT_EQ(result.steps[0].part, "peg");
  EXPECT_EQ(result.steps[0].verdict, Verdict::NotShown);
  EXPECT_EQ(result.steps[0].stuck_against, "lid");
  EXPECT_NE(result.steps[0].reason.find("gave up taking the part off"), std::string::npos)
      << result.steps[0].reason;
}

TEST(Disassembly, APegThatIsDrawnTooThickIsBlockedAsWhenItIsMounted) {
  PegInCup shape;
  shape.peg_m = shape.bore_m + 60e-6;
  Scene scene = disassemblyOf(pegInCup(shape));
  scene.steps[0].timeout_s = 1;
  const AssembleResult result = assemble(scene);
  EXPECT_EQ(result.steps[0].verdict, Verdict::Blocked);
  EXPECT_EQ(result.steps[0].blocked_by, "cup");
}

TEST(Disassembly, AScrewTurnsOutOfItsThreadAndLeavesAsItThenStands) {
  Scene scene = pegInCup({});
  SceneStep& step = scene.steps[0];
  step.motion = StepMotion::Screw;
  step.pitch_m = -2 * kMm;  // left-hand; 11 mm are five and a half turns
  const SceneStep off = disassemblyOf(scene).steps[0];
  EXPECT_EQ(off.motion, StepMotion::Push);
  std::vector<Pose> way{off.X_WP_start};
  way.insert(way.end(), off.way_points.begin(), off.way_points.end());
  way.push_back(off.X_WP_target);
  double turned_rad = 0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Vec3 turn = rotationVector(way[i].R * way[i - 1].R.transpose());
    EXPECT_LE(turn.norm(), 0.5 * std::numbers::pi + 1e-9);
    // A left-hand screw that moves up turns clockwise seen from above, which is negative about z.
    EXPECT_NEAR(turn.z() * 2 * kMm / (2 * std::numbers::pi), -(way[i].p - way[i - 1].p).z(), 1e-12);
    turned_rad += turn.z();
  }
  EXPECT_NEAR(turned_rad, -5.5 * 2 * std::numbers::pi, 1e-9);
  EXPECT_NEAR((way.back().p - step.X_WP_start.p).norm(), 0, 1e-12);  // the peg is round about its axis
}

TEST(Disassembly, ARecordedDisassemblyReplaysBitForBit) {
  const test::TemporaryFolder folder;
  Scene scene = disassemblyOf(pegInCup({}));
  const std::string file = (folder.path() / "off.mcap").string();
  const AssembleResult result = assembleAndRecord(scene, file);
  const ReplayResult again = replay(device::loadRecording(file));
  EXPECT_EQ(again.departure, "");
  EXPECT_TRUE(again.scene.steps[0].takes_off);
  test::expectSame(result, again.result);
}

TEST(Disassembly, ASceneInWhichNothingStandsStillIsRefusedWithARemedy) {
  Scene scene = pegInCup({});
  scene.parts[0].is_fixed = false;
  try {
    disassemblyOf(scene);
    FAIL();
  } catch (const LoadError& error) {
    EXPECT_NE(std::string(error.what()).find("fixed = true"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace vps::scenes
