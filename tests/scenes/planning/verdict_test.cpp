// SPDX-License-Identifier: BSD-3-Clause
// Verdicts of assemblies, on scenes whose correct verdict is known by construction.
#include <gtest/gtest.h>

#include <numbers>

#include "judge/body_motion.h"
#include "judge/overlap_judge.h"
#include "scenes/assemblies_to_plan.h"
#include "scenes/scene_part.h"
#include "step/way_check.h"
#include "support/lathe.h"
#include "support/units.h"
#include "vps/errors.h"
#include "vps/mesh.h"
#include "vps_scenes/planning/plan.h"
#include "vps_scenes/run/assemble.h"
#include "world/drawn_targets.h"

namespace vps::scenes {
namespace {

/// The parts; the last one is moved straight down to its target. The low rates keep a run below a few
/// seconds.
Scene sceneOf(std::vector<ScenePart> parts, double from_m) {
  Scene scene;
  scene.file = scene.name = "verdict";
  scene.parts = std::move(parts);
  SceneStep step;
  step.part = scene.parts.size() - 1;
  step.X_WP_target = scene.parts.back().X_WP;
  step.X_WP_start = step.X_WP_target;
  step.X_WP_start.p.z() += from_m;
  step.timeout_s = 10;
  scene.steps.push_back(step);
  scene.fidelity.haptic_rate_hz = scene.fidelity.physics_rate_hz = 250;
  scene.release_s = 0.2;
  scene.hand.aim_error_m = 0;
  scene.hand.aim_error_rad = 0;
  return scene;
}

constexpr int kFlats = 96;
constexpr double kPeg_m = 4 * kMm, kBore_m = 4.05 * kMm, kDepth_m = 10 * kMm, kChamfer_m = 0.5 * kMm;

/// A cup of 20 mm height from z = -14 mm, with a bore of 10 mm that is open at the top.
Mesh chamferedCup() {
  return test::lathe({{0, -14 * kMm},
                      {9 * kMm, -14 * kMm},
                      {9 * kMm, 0},
                      {kBore_m + kChamfer_m, 0},
                      {kBore_m, -kChamfer_m},
                      {kBore_m, -kDepth_m},
                      {0, -kDepth_m}},
                     kFlats);
}

/// A peg whose lower end is at z = 0.
Mesh peg(double length_m, double longer_m = 0) {
  return test::lathe({{0, -longer_m},
                      {kPeg_m - kChamfer_m, -longer_m},
                      {kPeg_m, kChamfer_m},
                      {kPeg_m, length_m},
                      {0, length_m}},
                     kFlats);
}

Scene pegInCup(double longer_m = 0) {
  return sceneOf({scenePart("cup", chamferedCup(), Vec3::Zero(), true),
                  scenePart("peg", peg(15 * kMm, longer_m), {0, 0, -kDepth_m}, false)},
                 11 * kMm);
}

TEST(Verdict, APegFitsItsHoleWithATolerancesTakenFromTheFit) {
  Scene scene = pegInCup();
  const AssembleResult result = assemble(scene);
  EXPECT_EQ(result.verdict, Verdict::Fits) << result.steps[0].reason;
  // 0.1 mm of diametral clearance plus 20 um exceed the greatest default tolerance.
  EXPECT_DOUBLE_EQ(result.steps[0].tolerance_m, 0.1 * kMm);
  EXPECT_LE(result.steps[0].final_error_m, 0.1 * kMm);
}

TEST(Verdict, TheToleranceIsStatedOrTheClearancePlusTwentyMicrometres) {
  Scene scene = pegInCup();
  scene.steps[0].clearance_m = 40e-6;
  scene.steps[0].timeout_s = 0.1;
  EXPECT_DOUBLE_EQ(assemble(scene).steps[0].tolerance_m, 60e-6);
  scene.steps[0].tolerance_m = 33e-6;
  EXPECT_DOUBLE_EQ(assemble(scene).steps[0].tolerance_m, 33e-6);
}

// The diametral clearance is 0.1 mm, so that a mesh may deviate by half of it.
TEST(Verdict, AMeshThatIsFartherOffItsFacesThanTheClearanceShowsNothing) {
  Scene scene = pegInCup();
  scene.parts[0].deflection_m = 49e-6;
  const AssembleResult near = assemble(scene);
  EXPECT_EQ(near.verdict, Verdict::Fits) << near.steps[0].reason;
  EXPECT_TRUE(near.steps[0].mesh_doubt.empty());
  scene.parts[0].deflection_m = 51e-6;
  const AssembleResult far = assemble(scene);
  EXPECT_EQ(far.verdict, Verdict::NotShown);
  EXPECT_TRUE(far.steps[0].completed);
  EXPECT_NE(far.steps[0].reason.find("the mesh of 'cup' differs by up to"), std::string::npos)
      << far.steps[0].reason;
  // Deviations from the rounding of the file do not change the verdict.
  scene.parts[0].deflection_m = 0;
  scene.parts[1].rounding_m = 51e-6;
  EXPECT_EQ(assemble(scene).verdict, Verdict::NotShown);
}

// The gap is 60 um between flat faces without a fit: meshes with a smaller error cannot touch, however small
// the tolerance.
TEST(Verdict, AMeshIsDoubtedWithoutAFitOnlyWhereItsErrorReachesTheOtherPart) {
  constexpr double kGap_m = 60e-6;
  Scene scene = sceneOf(
      {scenePart("plate", makeBox({30 * kMm, 30 * kMm, 4 * kMm}), Vec3::Zero(), true),
       scenePart("wall", makeBox({4 * kMm, 30 * kMm, 20 * kMm}), {5 * kMm + kGap_m, 0, 12 * kMm}, true),
       scenePart("block", makeBox({6 * kMm, 6 * kMm, 6 * kMm}), {0, 0, 5 * kMm}, false)},
      1 * kMm);
  scene.steps[0].tolerance_m = 20e-6;
  scene.parts[1].deflection_m = kGap_m - 1e-6;
  EXPECT_EQ(checkDrawnTargets(scene, {}).front().mesh_doubt, "");
  scene.parts[1].deflection_m = kGap_m + 1e-6;
  const std::string doubt = checkDrawnTargets(scene, {}).front().mesh_doubt;
  EXPECT_NE(doubt.find("the mesh of 'wall' differs by up to"), std::string::npos) << doubt;
}

// Released next to the cup, the peg falls 20 m in two seconds; the reported error is the one at the
// moment when the hand gave up.
TEST(Verdict, AStepThatTheHandGaveUpHasTheErrorOfThatMoment) {
  Scene scene = pegInCup();
  scene.steps[0].X_WP_start.p.x() += 30 * kMm;
  scene.steps[0].timeout_s = 0.3;
  scene.release_s = 2;
  const StepResult step = assemble(scene).steps[0];
  EXPECT_EQ(step.verdict, Verdict::NotShown);
  EXPECT_NE(step.reason.find("gave up"), std::string::npos) << step.reason;
  EXPECT_LT(step.final_error_m, 50 * kMm);
  EXPECT_GT(step.final_error_m, 1 * kMm);
}

// A peg that is 80 um too long for its drawn place stands 80 um higher. One that is 1.2 mm too long is
// farther off than a drawing may be.
TEST(Verdict, APegDrawnIntoTheBottomOfItsBlindHoleStandsHigherUnlessItIsFarTooLong) {
  Scene scene = pegInCup(80e-6);
  const AssembleResult result = assemble(scene);
  EXPECT_EQ(result.verdict, Verdict::Fits) << result.steps[0].reason;
  EXPECT_NEAR(result.steps[0].moved_m, 80e-6, 2e-6);
  EXPECT_EQ(result.steps[0].blocked_by, "");
  Scene longer = pegInCup(1.2e-3);
  const StepResult step = assemble(longer).steps[0];
  EXPECT_EQ(step.verdict, Verdict::Blocked);
  EXPECT_EQ(step.moved_m, 0);
  EXPECT_EQ(step.blocked_by, "cup");
  EXPECT_NEAR(step.blocked_depth_m, 1.2e-3, step.blocked_error_m + 1e-7);
  EXPECT_NEAR(step.blocked_at_W.z(), -kDepth_m - 1.2 * kMm, 0.1 * kMm);
}

// A key that is 20 um too wide for its slot: no place without overlap is found, and the depth is too small
// for a proof, since parts may be drawn that far off.
// A key that is 20 um wider than its slot. In one part the slot proves it; as two fixed walls, of which each
// alone leaves room, nothing does.
TEST(Verdict, AnOverlapForWhichNoPlaceIsFoundIsBlockedAsDrawnAndSaysWhetherItIsProven) {
  const Mesh floor = block({-20 * kMm, -9 * kMm, -4 * kMm}, {20 * kMm, 9 * kMm, 0});
  const Mesh left = block({-20 * kMm, 5 * kMm, 0}, {20 * kMm, 9 * kMm, 4 * kMm});
  const Mesh right = block({-20 * kMm, -9 * kMm, 0}, {20 * kMm, -5 * kMm, 4 * kMm});
  Mesh slot = floor;
  append(slot, left);
  append(slot, right);
  const auto fixed = [](const std::string& name, const Mesh& mesh) {
    return scenePart(name, mesh, Vec3::Zero(), true);
  };
  const ScenePart key = scenePart("key", makeBox({16 * kMm, 10.02 * kMm, 3 * kMm}), {0, 0, 1.5 * kMm}, false);
  const auto drawnStep = [&](const std::vector<ScenePart>& parts) {
    Scene scene = sceneOf(parts, 1 * kMm);
    return checkDrawnTargets(scene, {}).front();
  };
  const StepResult proven = drawnStep({fixed("slot", slot), key});
  EXPECT_EQ(proven.blocked_by, "slot");
  EXPECT_EQ(proven.overlap_doubt, "");
  const StepResult open = drawnStep({fixed("floor", floor), fixed("left", left), fixed("right", right), key});
  EXPECT_NE(open.blocked_by, "");
  EXPECT_EQ(open.moved_m, 0);
  EXPECT_NE(open.overlap_doubt.find("nothing proves"), std::string::npos) << open.overlap_doubt;
}

// Parts that are laid out next to each other, as for printing, reach their targets, but the run proves
// nothing.
TEST(Verdict, APartThatBelongsNowhereNearAnotherIsNotShownToFit) {
  const auto scene = [](double gap_m) {
    return sceneOf({scenePart("plate", makeBox({30 * kMm, 30 * kMm, 4 * kMm}), Vec3::Zero(), true),
                    scenePart("block", makeBox({6 * kMm, 6 * kMm, 6 * kMm}), {0, 0, 5 * kMm + gap_m}, false)},
                   1 * kMm);
  };
  Scene far = scene(20 * kMm), near = scene(0);
  const StepResult apart = checkDrawnTargets(far, {}).front();
  EXPECT_NE(apart.mesh_doubt.find("nowhere near another part"), std::string::npos) << apart.mesh_doubt;
  EXPECT_EQ(checkDrawnTargets(near, {}).front().mesh_doubt, "");
}

TEST(Verdict, ABlockDrawnInsideAPlateStandsHigherUnlessItIsDrawnTooDeep) {
  const auto scene = [](double deep_m) {
    return sceneOf(
        {scenePart("plate", makeBox({30 * kMm, 30 * kMm, 4 * kMm}), Vec3::Zero(), true),
         scenePart("block", makeBox({6 * kMm, 6 * kMm, 6 * kMm}), {0, 0, 5 * kMm - deep_m}, false)},
        1 * kMm);
  };
  for (const double deep_m : {2e-6, 90e-6}) {  // the block stands on the plate, higher than drawn
    Scene shallow = scene(deep_m);
    const AssembleResult result = assemble(shallow);
    EXPECT_EQ(result.verdict, Verdict::Fits) << result.steps[0].reason;
    EXPECT_NEAR(result.steps[0].moved_m, deep_m, 1.5e-6);
  }
  Scene deep = scene(0.7 * kMm);
  const AssembleResult result = assemble(deep);
  EXPECT_EQ(result.verdict, Verdict::Blocked);
  EXPECT_EQ(result.steps[0].blocked_by, "plate");
  EXPECT_NEAR(result.steps[0].blocked_depth_m, 0.7 * kMm, 0.3e-6);
  Scene touching = scene(0);
  EXPECT_EQ(assemble(touching).verdict, Verdict::Fits);
}

Mesh hollowBox() {
  const Mesh outer = makeBox({30 * kMm, 30 * kMm, 30 * kMm});
  Mesh both = outer;
  const Mesh inner = makeBox({24 * kMm, 24 * kMm, 24 * kMm});
  const auto first = static_cast<std::uint32_t>(both.vertices.size());
  both.vertices.insert(both.vertices.end(), inner.vertices.begin(), inner.vertices.end());
  for (const auto& t : inner.triangles) both.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  return both;
}

TEST(Verdict, NothingGetsIntoASealedBox) {
  const auto scene = [] {
    return sceneOf({scenePart("box", hollowBox(), Vec3::Zero(), true),
                    scenePart("cube", makeBox({4 * kMm, 4 * kMm, 4 * kMm}), {0, 0, -10 * kMm}, false)},
                   5 * kMm);
  };
  Scene inside = scene();
  const AssembleResult result = assemble(inside);
  EXPECT_EQ(result.verdict, Verdict::Blocked);
  EXPECT_EQ(result.steps[0].blocked_by, "box");
  EXPECT_NE(result.steps[0].reason.find("starts in a cavity"), std::string::npos);
  Scene outside = scene();
  outside.steps[0].X_WP_start = Pose::translation({0, 0, 20 * kMm});
  outside.steps[0].timeout_s = 1;
  const AssembleResult from_outside = assemble(outside);
  EXPECT_EQ(from_outside.verdict, Verdict::Blocked);
  EXPECT_NE(from_outside.steps[0].reason.find("target is in a cavity"), std::string::npos);
}

Scene pegThroughPlate() {
  const Mesh plate = test::lathe(
      {{kBore_m, -4 * kMm}, {9 * kMm, -4 * kMm}, {9 * kMm, 0}, {kBore_m, 0}, {kBore_m, -4 * kMm}}, kFlats);
  return sceneOf({scenePart("plate", plate, Vec3::Zero(), true),
                  scenePart("peg", peg(12 * kMm), {0, 0, -8 * kMm}, false)},
                 9 * kMm);
}

TEST(Verdict, APegThatFallsThroughItsHoleIsNotShownUntilTheSceneSaysThatItIsHeld) {
  Scene scene = pegThroughPlate();
  const AssembleResult result = assemble(scene);
  EXPECT_EQ(result.verdict, Verdict::NotShown);
  EXPECT_NE(result.steps[0].reason.find("holds = true"), std::string::npos) << result.steps[0].reason;
  scene.steps[0].is_held = true;
  const AssembleResult held = assemble(scene);
  EXPECT_EQ(held.verdict, Verdict::Fits) << held.steps[0].reason;
  EXPECT_EQ(held.steps[0].rest_drift_m, 0);
}

TEST(Verdict, AWayThroughAWallNamesTheWallAndWhatHoldsThePart) {
  Scene scene = sceneOf({scenePart("plate", makeBox({30 * kMm, 30 * kMm, 4 * kMm}), Vec3::Zero(), true),
                         scenePart("shelf", makeBox({30 * kMm, 30 * kMm, 2 * kMm}), {0, 0, 20 * kMm}, true),
                         scenePart("block", makeBox({6 * kMm, 6 * kMm, 6 * kMm}), {0, 0, 5 * kMm}, false)},
                        30 * kMm);
  scene.steps[0].timeout_s = 4;
  const AssembleResult result = assemble(scene);
  EXPECT_EQ(result.verdict, Verdict::NotShown);
  EXPECT_EQ(result.steps[0].stuck_against, "shelf");
  EXPECT_NEAR(result.steps[0].stuck_at_W.z(), 21 * kMm, 0.1 * kMm);
  EXPECT_NE(result.steps[0].reason.find("leads through 'shelf'"), std::string::npos)
      << result.steps[0].reason;
}

TEST(Verdict, LaterStepsSayThatTheyStandOnAPartThatDidNotArrive) {
  Scene scene = pegInCup();
  scene.parts.push_back(scenePart("pin", makeBox({3 * kMm, 3 * kMm, 3 * kMm}), {0, 0, 6.5 * kMm}, false));
  scene.steps[0].timeout_s = 0.1;  // too short to arrive
  SceneStep step;
  step.part = 2;
  step.X_WP_target = scene.parts[2].X_WP;
  step.X_WP_start = Pose::translation({0, 0, 7 * kMm});
  scene.steps.push_back(step);
  std::vector<std::size_t> told;
  AssembleOptions options;
  options.on_step = [&](const AssembleResult& so_far) { told.push_back(so_far.steps.size()); };
  const AssembleResult result = assemble(scene, options);
  EXPECT_EQ(result.verdict, Verdict::NotShown);
  EXPECT_EQ(result.steps[0].verdict, Verdict::NotShown);
  EXPECT_TRUE(result.steps[0].stands_on.empty());
  EXPECT_EQ(result.steps[1].stands_on, "peg");
  EXPECT_EQ(told, (std::vector<std::size_t>{1, 2}));
}

/// A collar with the cup's bore is placed on the cup by sight; then the peg goes through
/// both.
Scene pegThroughCollar() {
  Scene scene = pegInCup();
  scene.parts.insert(scene.parts.begin() + 1, scenePart("collar", makeTube(9 * kMm, kBore_m, 5 * kMm, kFlats),
                                                        {0, 0, 2.5 * kMm}, false));
  scene.steps[0].part = 2;
  scene.steps[0].X_WP_start.p.z() = 6 * kMm;
  scene.steps[0].timeout_s = 20;
  SceneStep lay;
  lay.part = 1;
  lay.X_WP_target = scene.parts[1].X_WP;
  lay.X_WP_start = Pose::translation({0, 0, 5 * kMm});
  scene.steps.insert(scene.steps.begin(), lay);
  scene.hand.aim_error_m = 0.3 * kMm;
  return scene;
}

TEST(Verdict, APartLaidDownBySightIsAlignedByThePegThatGoesThroughIt) {
  Scene scene = pegThroughCollar();
  const AssembleResult result = assemble(scene);
  const StepResult& laid = result.steps[0];
  // The collar's offset exceeds the clearance of the peg, which could not pass both bores.
  ASSERT_GT(laid.final_error_m, 0.1 * kMm);
  EXPECT_EQ(laid.aligned_by, "peg");
  ASSERT_EQ(result.steps.size(), 2U);
  EXPECT_EQ(result.steps[1].verdict, Verdict::Fits) << result.steps[1].reason;
  EXPECT_TRUE(result.steps[1].aligned_by.empty());
}

TEST(Verdict, APartIsNotAlignedByOneThatDoesNotArrive) {
  Scene scene = pegThroughCollar();
  scene.steps[1].timeout_s = 0.1;  // too short to arrive
  const AssembleResult result = assemble(scene);
  ASSERT_EQ(result.steps.size(), 2U);
  EXPECT_EQ(result.steps[1].verdict, Verdict::NotShown);
  EXPECT_TRUE(result.steps[0].aligned_by.empty()) << result.steps[0].aligned_by;
  EXPECT_EQ(result.steps[1].stands_on, "collar");
}

// A ring around a post is placed within the error of sight, with the post on the wrong side of the ring's
// wall.
TEST(Verdict, APartIsNotAlignedThroughAWall) {
  const auto bodyOf = [](const std::string& name, const Mesh& mesh) {
    VoxMapSettings voxels;
    voxels.voxel_m = 0.2 * kMm;
    PointShellSettings points;
    points.spacing_m = 0.5 * kMm;
    return makeJudgedBody(buildPartModel(name, mesh, voxels, points));
  };
  OverlapJudge judge;
  judge.mount(bodyOf("post", makeCylinder(0.2 * kMm, 10 * kMm, 24)), {});
  const JudgedBody ring = bodyOf("ring", makeTube(3 * kMm, 2.9 * kMm, 2 * kMm, 48));
  const auto at = [](double x_mm) { return Pose::translation({x_mm * kMm, 0, 0}); };
  constexpr double kLimit_m = 10e-6;
  EXPECT_TRUE(isFreeBetween(judge, ring, Vec3::Zero(), at(0.4), at(0), kLimit_m));
  EXPECT_TRUE(isFreeBetween(judge, ring, Vec3::Zero(), at(3.3), at(3.7), kLimit_m));
  EXPECT_FALSE(isFreeBetween(judge, ring, Vec3::Zero(), at(3.3), at(2.6), kLimit_m));
}

TEST(Verdict, APartThatNobodyHoldsIsRefusedByName) {
  Scene scene = pegInCup();
  scene.parts.push_back(scenePart("lid", makeBox({3 * kMm, 3 * kMm, 3 * kMm}), {0, 0, 40 * kMm}, false));
  try {
    assemble(scene);
    FAIL() << "accepted";
  } catch (const LoadError& error) {
    EXPECT_NE(std::string(error.what()).find("'lid'"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("scenery = true"), std::string::npos) << error.what();
  }
  scene.parts.back().is_scenery = true;
  scene.steps[0].timeout_s = 0.1;
  EXPECT_NO_THROW(assemble(scene));
}

TEST(SurfaceError, ATurnOfARoundPartAboutItsAxisIsNone) {
  const Solid solid(peg(15 * kMm));
  const double chord_m = kPeg_m * (1 - std::cos(std::numbers::pi / kFlats));
  const Pose turned(rotationFromVector({0, 0, 0.7}), Vec3::Zero());
  EXPECT_LE(surfaceError_m(solid, turned), chord_m);
  // Along its axis every point of the end faces moves by the same distance; the walls move within themselves.
  EXPECT_NEAR(surfaceError_m(solid, Pose::translation({0, 0, 30e-6})), 30e-6, 1e-9);
  EXPECT_NEAR(surfaceError_m(solid, Pose::translation({30e-6, 0, 0})), 30e-6, chord_m);
}

}  // namespace
}  // namespace vps::scenes
