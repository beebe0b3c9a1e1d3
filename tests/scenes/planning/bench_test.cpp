// SPDX-License-Identifier: BSD-3-Clause
// Starts on a bench, and the clearance along the paths.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "scenes/assemblies_to_plan.h"
#include "vps_scenes/planning/plan.h"

namespace vps::scenes {
namespace {

Box boxAt(const Mesh& mesh, const Pose& X_WP) {
  Box box;
  for (const Vec3& p : mesh.vertices) box.add(X_WP * p);
  return box;
}

/// Blocks of many sizes on a plate, and a lid over some.
std::vector<DrawnPart> crowd(int count) {
  std::vector<DrawnPart> parts = {at("plate", makeBox(Vec3(0.2, 0.2, 0.01)), {0, 0, -0.005})};
  for (int i = 0; i < count; ++i) {
    const Vec3 size_m(0.004 + 0.001 * (i % 5), 0.003 + 0.002 * (i % 3), 0.005 + 0.003 * (i % 7));
    parts.push_back(at("block " + std::to_string(i), makeBox(size_m),
                       {0.02 * (i % 9) - 0.08, 0.02 * (i / 9) - 0.08, 0.5 * size_m.z()}));
  }
  return parts;
}

void expectApart(const std::vector<DrawnPart>& parts, const Vec3& up_W) {
  PlanSettings settings;
  settings.has_bench = true;
  settings.up_W = up_W;
  const PlanResult plan = planAssembly("test", parts, settings);
  ASSERT_EQ(plan.blocked(), 0U);
  std::map<std::string, const DrawnPart*> drawn;
  for (const DrawnPart& part : parts) drawn[part.name] = &part;
  std::vector<Box> boxes;
  for (const DrawnPart& part : parts) boxes.push_back(boxAt(part.mesh, part.X_WP));
  const std::size_t homes = boxes.size();
  for (const PlannedStep& step : plan.assemblies.front().steps) {
    EXPECT_TRUE(step.is_on_bench) << step.name;
    const DrawnPart& part = *drawn.at(step.name);
    boxes.push_back(boxAt(part.mesh, step.before_W.front() * part.X_WP));
  }
  for (std::size_t i = homes; i < boxes.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(overlap(boxes[i], boxes[k])) << i << " " << k;
  Scene scene = plannedScenes(sceneOf(parts), plan).front();
  scene.gravity_W = -9.81 * up_W;
  for (const WayFault& fault : checkWays(scene))
    ADD_FAILURE() << toText(fault.kind) << " " << fault.part << " " << fault.against << " by "
                  << fault.depth_m;
}

TEST(Bench, NoPartLiesOnAnotherOneOrOnTheAssembly) {
  expectApart(crowd(1), Vec3::UnitZ());
  expectApart(crowd(60), Vec3::UnitZ());
}

TEST(Bench, ItsPlaneFollowsWhatIsUp) {
  const Pose X_W(rotationFromVector({0.5 * 3.14159265358979, 0, 0}), {0.1, 0, 0});
  std::vector<DrawnPart> parts = crowd(20);
  for (DrawnPart& part : parts) part.X_WP = X_W * part.X_WP;
  expectApart(parts, X_W.R * Vec3::UnitZ());
}

// The part comes from the side, under a roof, so that it cannot be lowered straight to its start.
TEST(Bench, APartThatComesFromTheSideIsCarriedAroundTheRoof) {
  const std::vector<DrawnPart> parts = {
      at("box", roofedBox(), {0, 0, 0}), at("plate", makeBox(Vec3(0.1, 0.1, 0.002)), {0, 0, -0.0061}),
      at("tail", dovetailTail(), {0, 0, 0.05}), at("groove", dovetailGroove(), {0, 0, 0.05})};
  expectApart({parts[2], parts[3]}, Vec3::UnitZ());
}

// A block passes a pillar at a distance of 1.5 mm on its way down to the plate; a second block is 3 mm away.
TEST(WayClearance, IsThatToTheNearestPartThatIsPassed) {
  const std::vector<DrawnPart> parts = {at("plate", makeBox(Vec3(0.1, 0.1, 0.01)), {0, 0, -0.005}),
                                        at("pillar", makeBox(Vec3(0.01, 0.01, 0.05)), {0, 0, 0.025}),
                                        at("block", makeBox(Vec3::Constant(0.01)), {0.0115, 0, 0.005})};
  PlanSettings settings;
  settings.fixed = {"plate", "pillar"};
  const PlanResult plan = planAssembly("test", parts, settings);
  const PlannedStep& step = plan.assemblies.front().steps.front();
  ASSERT_TRUE(step.clearance_m);
  EXPECT_NEAR(*step.clearance_m, 1.5e-3, 2e-6);  // the search ends within a thousandth of the distance
  EXPECT_EQ(step.nearest, "pillar");
  EXPECT_FALSE(step.fit_clearance_m);
}

// A bump on the pillar, halfway up, is near only to a path that comes from high above.
TEST(WayClearance, IsFoundInTheMiddleOfAWay) {
  Mesh pillar = block({0, -0.005, 0}, {0.01, 0.005, 0.08});
  append(pillar, block({0.005, -0.005, 0.0381}, {0.0137, 0.005, 0.0384}));
  const std::vector<DrawnPart> parts = {at("plate", makeBox(Vec3(0.1, 0.1, 0.01)), {0, 0, -0.005}),
                                        at("pillar", pillar, {0, 0, 0}),
                                        at("block", makeBox(Vec3::Constant(0.01)), {0.019, 0, 0.005})};
  PlanSettings settings;
  settings.fixed = {"plate", "pillar"};
  settings.has_bench = true;
  const PlanResult plan = planAssembly("test", parts, settings);
  const PlannedStep& step = plan.assemblies.front().steps.front();
  ASSERT_TRUE(step.clearance_m);
  EXPECT_NEAR(*step.clearance_m, 0.3e-3, 2e-6);
}

TEST(WayClearance, OfAFitIsThatOfTheFit) {
  const PlanResult plan = planAssembly("test", {at("block", makeTube(20e-3, 5.02e-3, 20e-3, 96), {0, 0, 0}),
                                                at("peg", makeCylinder(5e-3, 0.02, 96), {0, 0, 0})});
  const PlannedStep& step = plan.assemblies.front().steps.front();
  ASSERT_TRUE(step.fit_clearance_m);
  EXPECT_NEAR(*step.fit_clearance_m, 40e-6, 1e-6);
  EXPECT_FALSE(step.clearance_m);
}

}  // namespace
}  // namespace vps::scenes
