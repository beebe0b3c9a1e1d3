// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/scene/model_plan.h"
#include "support/units.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <string_view>

#include "scenes/scene_part.h"
#include "vps/box.h"
#include "vps/errors.h"
#include "vps_scenes/run/assemble.h"
#include "vps_scenes/run/explain.h"
#include "vps_scenes/run/simulate.h"

namespace vps::scenes {
namespace {

/// A pin that is set down on a plate of 40 mm; a shelf 100 mm away, which no part approaches; a label that no
/// step moves; a copy of the pin for the second step. The low rates keep a run below a second.
Scene pinsOnPlate() {
  Scene scene;
  scene.file = scene.name = "pins";
  const Mesh pin = makeBox({2 * kMm, 2 * kMm, 2 * kMm});
  scene.parts = {scenePart("plate", makeBox({40 * kMm, 40 * kMm, 2 * kMm}), Vec3::Zero(), true),
                 scenePart("shelf", makeBox({9 * kMm, 9 * kMm, 9 * kMm}), {100 * kMm, 0, 0}, true),
                 scenePart("label", makeBox({3 * kMm, 3 * kMm, 1 * kMm}), {0, 0, 50 * kMm}, false),
                 scenePart("pin", pin, {0, 0, 2 * kMm}, false),
                 scenePart("twin", pin, {10 * kMm, 0, 2 * kMm}, false)};
  scene.parts[2].is_scenery = true;
  for (const std::size_t i : {3u, 4u}) {
    SceneStep step;
    step.part = i;
    step.X_WP_target = scene.parts[i].X_WP;
    step.tolerance_m = 0.5 * kMm;  // nothing guides the pins across: five standard deviations of sight
    step.X_WP_start = Pose::translation(scene.parts[i].X_WP.p + Vec3(0, 0, 0.2 * kMm));
    scene.steps.push_back(step);
  }
  scene.fidelity.haptic_rate_hz = scene.fidelity.physics_rate_hz = 250;
  scene.release_s = 0.1;
  scene.hand.aim_error_m = 0.05 * kMm;
  return scene;
}

AssembleResult assembled(Scene scene, bool models_everything) {
  AssembleOptions options;
  options.models_everything = models_everything;
  return assemble(scene, options);
}

SimulateResult simulated(Scene scene, bool models_everything) {
  SimulateOptions options;
  options.models_everything = models_everything;
  return simulate(scene, 0.2, options);
}

/// Greatest distance between the parts of two runs at the same step; infinite if the runs differ in length.
double greatestDistance(const AssembleResult& a, const AssembleResult& b) {
  if (a.trace.size() != b.trace.size()) return INFINITY;
  double greatest_m = 0;
  for (std::size_t i = 0; i < a.trace.size(); ++i)
    greatest_m = std::max(greatest_m, (a.trace[i].X_WP.p - b.trace[i].X_WP.p).norm());
  return greatest_m;
}

TEST(ModelPlan, ModelsThatDoNotFitTheMemoryAreRefusedInWordsBeforeTheyAreBuilt) {
  Scene scene = pinsOnPlate();
  const double needed_bytes =
      static_cast<double>(estimate(scene, ModelPurpose::Assemble, {}).cost.most.bytes);
  AssembleOptions options;
  options.progress = [](std::string_view doing, double) {
    if (doing.starts_with("modelling")) ADD_FAILURE() << doing;
  };
  options.memory_bytes = 0.1 * needed_bytes;
  try {
    assemble(scene, options);
    FAIL() << "was not refused";
  } catch (const LoadError& error) {
    EXPECT_NE(std::string(error.what()).find("MB of memory"), std::string::npos) << error.what();
  }
  // The estimate of the models alone is at most the estimate with the fixed field, which `most` counts.
  options.progress = {};
  options.memory_bytes = 1.01 * needed_bytes;
  EXPECT_NO_THROW(assemble(scene, options));
}

TEST(ModelPlan, PartsThatNothingCanTouchAreNotModelledAndTheReasonIsGiven) {
  const ModelPlan plan = makeModelPlan(pinsOnPlate(), ModelPurpose::Assemble);
  for (const std::size_t i : {1u, 2u}) {
    EXPECT_FALSE(plan.parts[i].has_map || plan.parts[i].has_shell) << i;
    EXPECT_NE(plan.parts[i].why.find("nothing can touch the part"), std::string::npos) << plan.parts[i].why;
  }
  for (const std::size_t i : {0u, 3u, 4u}) EXPECT_TRUE(plan.parts[i].has_map && plan.parts[i].has_shell) << i;
  EXPECT_NE(plan.parts[3].why.find("moves in step 1"), std::string::npos) << plan.parts[3].why;
  EXPECT_EQ(useOf(plan, 1, 0), PartUse::LeftOut);
  EXPECT_EQ(useOf(plan, 3, 0), PartUse::Moves);
  EXPECT_EQ(useOf(plan, 4, 0), PartUse::Absent);
  EXPECT_EQ(useOf(plan, 3, 1), PartUse::LeftOut) << "mounted 8 mm from the twin's path";
}

TEST(ModelPlan, EqualGeometryIsBuiltOnce) {
  const ModelPlan plan = makeModelPlan(pinsOnPlate(), ModelPurpose::Assemble);
  EXPECT_EQ(plan.parts[4].same_as, std::optional<std::size_t>(3));
  EXPECT_FALSE(plan.parts[3].same_as);
}

TEST(ModelPlan, ARegionContainsTheWholePathAndTheErrorOfTheHand) {
  Scene scene = pinsOnPlate();
  scene.steps[0].way_points = {Pose::translation({0, 20 * kMm, 30 * kMm})};
  const ModelPlan plan = makeModelPlan(scene, ModelPurpose::Assemble);
  // The band is 4 voxels of 0.25 mm, and 4 standard deviations are 0.2 mm; the region is larger than their
  // sum.
  for (const Pose& X_WP :
       {scene.steps[0].X_WP_start, scene.steps[0].way_points[0], scene.steps[0].X_WP_target})
    EXPECT_TRUE(
        isWithin(grown(moved(bounds(scene.parts[3].part.mesh), X_WP), 1.2 * kMm), *plan.steps[0].region_W));
}

TEST(ModelPlan, ModelsEverythingLeavesNothingOut) {
  const ModelPlan plan = makeModelPlan(pinsOnPlate(), ModelPurpose::Assemble, true);
  for (const PartModelPlan& planned : plan.parts)
    EXPECT_TRUE(planned.has_map && planned.has_shell && !planned.same_as && planned.kept_P.empty());
  for (const FieldPlan& step : plan.steps) EXPECT_TRUE(!step.region_W && step.left_out.empty());
}

TEST(ModelPlan, InOneSidedQueriesTheLargerBodyNeedsNoPoints) {
  Scene scene = pinsOnPlate();
  scene.fidelity.sides = Sides::One;
  for (const FieldPlan& step : makeModelPlan(scene, ModelPurpose::Assemble).steps)
    EXPECT_FALSE(step.has_shell);
  scene.parts.resize(4);  // plate, shelf and pin
  scene.parts.erase(scene.parts.begin() + 2);
  scene.steps.clear();
  const ModelPlan plan = makeModelPlan(scene, ModelPurpose::Simulate);
  EXPECT_FALSE(plan.parts[2].has_map) << "no points are tested against the only part that moves";
  EXPECT_TRUE(plan.parts[2].has_shell);
}

TEST(ModelPlan, IfNothingMovesNothingIsModelled) {
  Scene scene = pinsOnPlate();
  scene.parts.resize(2);
  scene.steps.clear();
  const ModelPlan plan = makeModelPlan(scene, ModelPurpose::Simulate);
  for (const PartModelPlan& planned : plan.parts) EXPECT_FALSE(planned.has_map || planned.has_shell);
  EXPECT_TRUE(plan.steps[0].cooked.empty());
}

// Within its region a part reads the same nodes and the same points in the same order (shell_crop.h,
// voxmap_crop.h): the same bits, so no tolerance.
TEST(ModelPlan, AReducedAssemblyEqualsTheWholeOneToTheBitWithLessMemory) {
  const AssembleResult reduced = assembled(pinsOnPlate(), false), all = assembled(pinsOnPlate(), true);
  ASSERT_TRUE(reduced.completed) << reduced.steps[0].failure_reason;
  EXPECT_EQ(greatestDistance(reduced, all), 0);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(reduced.steps[i].max_penetration_m, all.steps[i].max_penetration_m);
    EXPECT_EQ(reduced.steps[i].final_error_m, all.steps[i].final_error_m);
    EXPECT_EQ(reduced.steps[i].peak_force_N, all.steps[i].peak_force_N);
  }
  EXPECT_EQ(reduced.widened, 0);
  EXPECT_LT(reduced.modelled.bytes, all.modelled.bytes / 2);
  EXPECT_LT(reduced.modelled.field_points, all.modelled.field_points / 4);
}

// The pin is released 10 mm above the plate and falls out of its region onto a plate that was not modelled.
TEST(ModelPlan, APartThatLeavesItsRegionMeetsTheFixedPartsAroundItAsWell) {
  Scene scene = pinsOnPlate();
  scene.steps.resize(1);
  scene.parts[4].is_scenery = true;
  scene.steps[0].X_WP_start = Pose::translation({0, 0, 12.2 * kMm});
  scene.steps[0].X_WP_target = Pose::translation({0, 0, 12 * kMm});
  EXPECT_EQ(useOf(makeModelPlan(scene, ModelPurpose::Assemble), 0, 0), PartUse::LeftOut);
  const AssembleResult reduced = assembled(scene, false), all = assembled(scene, true);
  EXPECT_EQ(reduced.widened, 2);
  EXPECT_EQ(all.widened, 0);
  // The pin lies on the plate; half the thickness of each is 1 mm.
  EXPECT_NEAR(reduced.trace.back().X_WP.p.z(), 2 * kMm, 10e-6);
  // The new field is another body, which may swap the bodies of the pair, so the bits differ. The limit is
  // the drift that a part at rest may have; measured 0.4 um.
  EXPECT_LE(greatestDistance(reduced, all), kRestDriftLimit_m);
  EXPECT_LE(reduced.steps[0].max_penetration_m, reduced.steps[0].penetration_limit_m);
  // The shelf, 100 mm away, is not modelled. Some 60 % of the plate lies inside the pin's new region.
  EXPECT_EQ(reduced.modelled.voxmaps, 3u) << "plate, pin and field";
  EXPECT_LT(reduced.modelled.field_points, all.modelled.field_points);
}

// With voxels of 0.1 mm a region grows by 5.1, 10, 20 and 41 mm, and is then unbounded.
TEST(ModelPlan, APartThatFallsFarMeetsWhatIsFarBelow) {
  Scene scene = pinsOnPlate();
  scene.steps.resize(1);
  scene.parts[4].is_scenery = true;
  scene.fidelity.voxel_m = 0.1 * kMm;
  scene.fidelity.spacing_m = 0.2 * kMm;
  scene.release_s = 0.3;  // a fall of 150 mm takes 0.17 s
  scene.steps[0].X_WP_start = Pose::translation({0, 0, 152.2 * kMm});
  scene.steps[0].X_WP_target = Pose::translation({0, 0, 152 * kMm});
  const AssembleResult reduced = assembled(scene, false);
  EXPECT_EQ(reduced.widened, 5);
  EXPECT_NEAR(reduced.trace.back().X_WP.p.z(), 2 * kMm, 10e-6);
}

TEST(ModelPlan, AReducedSimulationEqualsTheWholeOneToTheBitWithLessMemory) {
  Scene scene = pinsOnPlate();
  scene.steps.clear();
  for (const Sides sides : {Sides::Both, Sides::One}) {
    scene.fidelity.sides = sides;
    const SimulateResult reduced = simulated(scene, false), all = simulated(scene, true);
    for (std::size_t i = 0; i < reduced.bodies.size(); ++i)
      EXPECT_EQ((reduced.bodies[i].X_WP.p - all.bodies[i].X_WP.p).norm(), 0) << reduced.bodies[i].name;
    EXPECT_EQ(reduced.max_penetration_m, all.max_penetration_m);
    EXPECT_GT(reduced.contact_step.count, 10u);
    EXPECT_LT(reduced.modelled.bytes, all.modelled.bytes);
  }
}

TEST(Explain, CostsEqualThoseOfTheRun) {
  const AssembleResult run = assembled(pinsOnPlate(), false);
  const ExplainedModels explained = explain(pinsOnPlate(), ModelPurpose::Assemble, {});
  EXPECT_EQ(explained.cost.most.bytes, run.modelled.bytes);
  EXPECT_EQ(explained.cost.most.field_points, run.modelled.field_points);
  EXPECT_EQ(explained.cost.parts[1].map_bytes, 0u);
  EXPECT_EQ(explained.cost.parts[4].points, 0u) << "shared";
  EXPECT_TRUE(explained.cost.steps[0].is_cooked && explained.cost.steps[1].is_cooked);
}

}  // namespace
}  // namespace vps::scenes
