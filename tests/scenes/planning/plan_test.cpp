// SPDX-License-Identifier: BSD-3-Clause
// Orders and paths of assemblies for which both are known.
#include "vps_scenes/planning/plan.h"
#include "vps_scenes/planning/plan_fields.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "scenes/assemblies_to_plan.h"
#include "support/screw.h"

namespace vps::scenes {
namespace {

std::vector<std::string> stepsOf(const PlannedAssembly& assembly) {
  std::vector<std::string> names;
  for (const PlannedStep& step : assembly.steps) names.push_back(step.name);
  return names;
}
bool has(const std::vector<PlannedOrder>& order, const std::string& before, const std::string& after) {
  return std::ranges::any_of(
      order, [&](const PlannedOrder& one) { return one.before == before && one.after == after; });
}
using Names = std::vector<std::string>;

TEST(Plan, ABlockOnAPlateComesFromAbove) {
  const std::vector<DrawnPart> parts = {at("block", makeBox(Vec3::Constant(0.02)), {0, 0, 0.015}),
                                        at("plate", makeBox(Vec3(0.1, 0.1, 0.01)), {0, 0, 0})};
  const PlanResult plan = planAssembly("test", parts);
  ASSERT_EQ(plan.assemblies.size(), 1U);
  const PlannedAssembly& whole = plan.assemblies.front();
  EXPECT_EQ(whole.fixed, Names{"plate"});
  ASSERT_EQ(stepsOf(whole), Names{"block"});
  const PlannedStep& step = whole.steps.front();
  EXPECT_EQ(step.kind, WayKind::Straight);
  EXPECT_LT((step.insertion_W - Vec3(0, 0, -1)).norm(), 1e-12);
  // The block's start is half of its own height above its target.
  ASSERT_EQ(step.before_W.size(), 1U);
  EXPECT_NEAR(step.before_W.front().p.z(), 0.01, 1e-9);
  EXPECT_TRUE(step.is_carried);
  EXPECT_EQ(plan.blocked(), 0U);
  expectFreeWays(parts, plan);
}

TEST(Plan, NestedCupsGoFromTheOutsideIn) {
  const std::vector<DrawnPart> parts = {
      at("core", makeBox(Vec3::Constant(0.008)), {0, 0, 0.007}), at("cup 2", cup(0.02, 0.001), {0, 0, 0.002}),
      at("cup 3", cup(0.03, 0.001), {0, 0, 0.001}), at("cup 1", cup(0.01, 0.0005), {0, 0, 0.003}),
      at("cup 4", cup(0.04, 0.001), {0, 0, 0})};
  PlanSettings settings;
  settings.fixed = {"cup 4"};
  const PlanResult plan = planAssembly("test", parts, settings);
  EXPECT_EQ(stepsOf(plan.assemblies.front()), (Names{"cup 3", "cup 2", "cup 1", "core"}));
  expectFreeWays(parts, plan);
}

TEST(Plan, APegInABlindHoleHasOneDirection) {
  const std::vector<DrawnPart> parts = {at("block", blindHole(), {0, 0, 0}),
                                        at("peg", makeCylinder(4e-3, 0.02, 96), {0, 0, 0.01})};
  // The assembly lies on its side, so the upward direction does not decide.
  std::vector<DrawnPart> turned = parts;
  const Pose X_W(rotationFromVector({1.2, 0.3, -0.4}), {0.01, 0.02, 0.03});
  for (DrawnPart& part : turned) part.X_WP = X_W * part.X_WP;
  for (const auto& [drawn, axis_W] :
       {std::pair(parts, Vec3(0, 0, 1)), std::pair(turned, Vec3(X_W.R.col(2)))}) {
    const PlanResult plan = planAssembly("test", drawn);
    ASSERT_EQ(stepsOf(plan.assemblies.front()), Names{"peg"});
    EXPECT_LT((plan.assemblies.front().steps.front().insertion_W + axis_W).norm(), 1e-6);
    expectFreeWays(drawn, plan);
  }
}

// The peg's facets are tilted against the bore's by a fraction of their chord errors, everywhere and in every
// direction.
TEST(Plan, APegOfUnevenFacetsLeavesABoreOfItsOwnSize) {
  const Pose X_W(rotationFromVector({0.4, -0.2, 0.1}), {0, 0, 0});
  const std::vector<DrawnPart> parts = {
      {"block", makeTube(10e-3, 4e-3, 20e-3, 96), X_W, {}, false},
      {"peg", unevenCylinder(4e-3, 60e-3, 96, 120), X_W, {}, false},
      {"collar", makeTube(6e-3, 4e-3, 5e-3, 80), X_W * Pose::translation({0, 0, 20e-3}), {}, false}};
  PlanSettings settings;
  settings.fixed = {"block"};
  const PlanResult plan = planAssembly("test", parts, settings);
  ASSERT_EQ(plan.blocked(), 0U);
  ASSERT_EQ(plan.assemblies.size(), 1U);
  for (const PlannedStep& step : plan.assemblies.front().steps) {
    EXPECT_EQ(step.kind, WayKind::Straight);
    EXPECT_NEAR(std::abs(step.insertion_W.dot(X_W.R.col(2))), 1, 1e-9);
  }
  expectFreeWays(parts, plan);
}

// Once its bolt has left, the nut could leave in any direction.
TEST(Plan, ANutComesAlongItsBolt) {
  const Mesh bolt =
      test::lathe({{0, -15e-3}, {4e-3, -15e-3}, {4e-3, 5e-3}, {7e-3, 5e-3}, {7e-3, 10e-3}, {0, 10e-3}}, 64);
  const std::vector<DrawnPart> parts = {at("plate", makeTube(30e-3, 4.1e-3, 10e-3, 64), {0, 0, 0}),
                                        at("bolt", bolt, {0, 0, 0}),
                                        at("nut", makeTube(8e-3, 4.05e-3, 4e-3, 64), {0, 0, -7e-3})};
  const PlanResult plan = planAssembly("test", parts);
  ASSERT_EQ(plan.assemblies.front().steps.size(), 2U);
  for (const PlannedStep& step : plan.assemblies.front().steps) {
    EXPECT_LT((step.insertion_W - Vec3(0, 0, step.name == "nut" ? 1 : -1)).norm(), 1e-6) << step.name;
    EXPECT_EQ(step.is_carried, step.name == "bolt");
  }
  expectFreeWays(parts, plan);
}

/// A box along x, in the middle.
Mesh alongX(const Mesh& alongZ) {
  return transformed(alongZ, Pose(rotationFromVector({0, std::numbers::pi / 2, 0}), Vec3::Zero()));
}

// A pin through one wall leans by its play, since its centre of mass is not in the wall; a pin through two
// walls does not.
TEST(Plan, APinThatLeansInALevelHoleIsHeld) {
  const Mesh wall = alongX(makeTube(20e-3, 5.025e-3, 8e-3, 64));
  const Mesh pin = alongX(makeCylinder(5e-3, 40e-3, 64));
  const auto isCarried = [&](std::vector<DrawnPart> parts, const Vec3& p_W) {
    PlanSettings settings;
    for (const DrawnPart& part : parts) settings.fixed.push_back(part.name);
    parts.push_back(at("pin", pin, p_W));
    const PlanResult plan = planAssembly("test", parts, settings);
    EXPECT_EQ(plan.blocked(), 0U);
    return plan.assemblies[0].steps.at(0).is_carried;
  };
  const Vec3 lies = {0, 0, -0.025e-3};  // the pin lies on the bottom of the hole
  EXPECT_TRUE(isCarried({at("wall", wall, {0, 0, 0})}, lies));
  EXPECT_FALSE(isCarried({at("wall", wall, {0, 0, 0})}, lies + Vec3(10e-3, 0, 0)));
  EXPECT_TRUE(
      isCarried({at("wall", wall, {0, 0, 0}), at("other", wall, {15e-3, 0, 0})}, lies + Vec3(10e-3, 0, 0)));
}

// A plate on a wide block is stable; on a narrow block at its end it tips over.
TEST(Plan, APlateThatIsCarriedBesideItsMiddleIsHeld) {
  const auto isCarried = [](double at_m) {
    const std::vector<DrawnPart> parts = {at("block", makeBox(Vec3(0.02, 0.02, 0.04)), {at_m, 0, 0}),
                                          at("plate", makeBox(Vec3(0.06, 0.01, 0.01)), {0, 0, 0.025})};
    PlanSettings settings;
    settings.fixed = {"block"};
    const PlanResult plan = planAssembly("test", parts, settings);
    EXPECT_EQ(plan.blocked(), 0U);
    return plan.assemblies[0].steps.at(0).is_carried;
  };
  EXPECT_TRUE(isCarried(0));
  EXPECT_TRUE(isCarried(0.009));   // the block ends a millimetre beyond the plate's middle
  EXPECT_FALSE(isCarried(0.014));  // the block ends 4 mm before the plate's middle: 6 % of the plate's size;
                                   // up to 3 % counts as balanced
  EXPECT_FALSE(isCarried(-0.025));
}

// The hand needs the default time for the path of a long rod alone.
TEST(Plan, AStepHasTimeForItsWayAndForTheUsualWork) {
  const std::vector<DrawnPart> parts = {at("wall", makeTube(20e-3, 5.025e-3, 8e-3, 64), {0, 0, 0}),
                                        at("rod", makeCylinder(5e-3, 0.3, 64), {0, 0, 0})};
  const Scene scene = sceneOf(parts);
  PlanSettings settings;
  settings.fixed = {"wall"};
  const Scene planned = plannedScenes(scene, planAssembly(scene, settings)).front();
  const SceneStep& step = planned.steps.at(0);
  const double way_s = (step.X_WP_target.p - step.X_WP_start.p).norm() / planned.hand.speed_m_s;
  EXPECT_GT(way_s, 5);
  constexpr double kSearches_s = 40;  // two rounds of each kind of search
  EXPECT_GE(step.timeout_s, SceneStep().timeout_s + kSearches_s + way_s);
}

TEST(Plan, APartDrawnTwiceIsNamed) {
  const Mesh brick = makeBox(Vec3::Constant(0.02));
  std::vector<DrawnPart> parts = {at("plate", makeBox(Vec3(0.1, 0.1, 0.01)), {0, 0, 0}),
                                  at("one", brick, {0, 0, 0.015}), at("two", brick, {0.03, 0, 0.015})};
  EXPECT_TRUE(planAssembly("test", parts).twice.empty());
  parts.back().X_WP = parts[1].X_WP;
  const PlanResult plan = planAssembly("test", parts);
  ASSERT_EQ(plan.twice.size(), 1U);
  EXPECT_EQ(plan.twice.front().first, "one");
  EXPECT_EQ(plan.twice.front().second, "two");
  // A part at nearly the same place is an overlap and not a duplicate.
  parts.back().X_WP.p.x() = 0.1e-3;
  EXPECT_TRUE(planAssembly("test", parts).twice.empty());
}

TEST(Plan, ADovetailSlidesAlongItsGroove) {
  const std::vector<DrawnPart> parts = {at("groove", dovetailGroove(), {0, 0, 0}),
                                        at("tail", dovetailTail(), {0, 0, 0})};
  const PlanResult plan = planAssembly("test", parts);
  ASSERT_EQ(stepsOf(plan.assemblies.front()), Names{"tail"});
  const PlannedStep& step = plan.assemblies.front().steps.front();
  EXPECT_EQ(step.kind, WayKind::Straight);
  EXPECT_NEAR(std::abs(step.insertion_W.y()), 1, 1e-9);
  expectFreeWays(parts, plan);
}

// The tail rests on the groove's floor, with 0.125 mm to each wall; the walls lean by 0.5 mm per mm of
// height. The tail moves in the middle of its vertical play of 0.25 mm, and is lowered at the end. If the
// tail is drawn in the middle of its play, it moves straight.
TEST(Plan, ATailThatRestsInItsGrooveGoesWhereItHasMostRoom) {
  for (const double z_m : {0.0, -0.05e-3}) {
    const std::vector<DrawnPart> parts = {at("groove", dovetailGroove(), {0, 0, 0}),
                                          at("tail", dovetailTail(), {0, 0, z_m})};
    const PlanResult plan = planAssembly("test", parts);
    ASSERT_EQ(stepsOf(plan.assemblies.front()), Names{"tail"});
    const PlannedStep& step = plan.assemblies.front().steps.front();
    EXPECT_EQ(step.kind, WayKind::Straight);
    EXPECT_NEAR(std::abs(step.insertion_W.y()), 1, 1e-9);
    ASSERT_EQ(step.before_W.size(), z_m < 0 ? 2U : 1U);
    for (const Pose& before_W : step.before_W)
      EXPECT_NEAR(before_W.p.z(), z_m < 0 ? 0.083e-3 : 0, 16e-6) << z_m;
    if (z_m < 0) {
      EXPECT_NEAR(step.before_W.back().p.y(), 0, 1e-9);
    }
    expectFreeWays(parts, plan);
  }
}

TEST(Plan, ALidComesAfterWhatItCovers) {
  const std::vector<DrawnPart> parts = {at("lid", makeBox(Vec3(0.04, 0.04, 0.004)), {0, 0, 0.042}),
                                        at("cup", cup(0.04, 0.002), {0, 0, 0}),
                                        at("part", makeBox(Vec3::Constant(0.01)), {0.005, 0, 0.007})};
  PlanSettings settings;
  settings.fixed = {"cup"};
  const PlanResult plan = planAssembly("test", parts, settings);
  EXPECT_EQ(stepsOf(plan.assemblies.front()), (Names{"part", "lid"}));
  EXPECT_TRUE(has(plan.assemblies.front().order, "part", "lid"));
  EXPECT_NE(planDot(plan).find("\"0/part\" -> \"0/lid\""), std::string::npos);
}

// All three parts could be taken off in any order, but the lower ones carry the upper ones.
TEST(Plan, WhatStandsOnOthersComesAfterThem) {
  const Mesh brick = makeBox(Vec3(0.02, 0.02, 0.01));
  const std::vector<DrawnPart> parts = {at("second", brick, {0, 0, 0.02}), at("third", brick, {0, 0, 0.03}),
                                        at("first", brick, {0, 0, 0.01}),
                                        at("floor", makeBox(Vec3(0.1, 0.1, 0.01)), {0, 0, 0})};
  const PlanResult plan = planAssembly("test", parts);
  EXPECT_EQ(stepsOf(plan.assemblies.front()), (Names{"first", "second", "third"}));
}

TEST(Plan, AScrewTurnsOutOfItsNut) {
  test::ThreadShape thread;
  thread.clearance_m = 0;
  thread.columns = 48;
  thread.rows_per_pitch = 16;
  test::ThreadShape nut = thread;
  nut.length_m = 8e-3;
  nut.clearance_m = 0.1e-3;
  const std::vector<DrawnPart> parts = {at("nut", test::makeNut(nut, 0.011), {0, 0, 0}),
                                        at("rod", test::makeThreadedRod(thread), {0, 0, 0})};
  PlanSettings settings;
  settings.fixed = {"nut"};
  const PlanResult plan = planAssembly("test", parts, settings);
  ASSERT_EQ(stepsOf(plan.assemblies.front()), Names{"rod"});
  const PlannedStep& step = plan.assemblies.front().steps.front();
  EXPECT_EQ(step.kind, WayKind::Screw);
  EXPECT_NEAR(step.lead_m, thread.pitch_m, 1e-6);
  EXPECT_NEAR(std::abs(step.insertion_W.z()), 1, 1e-6);
  const std::vector<Scene> scenes = plannedScenes(sceneOf(parts), plan);
  EXPECT_EQ(scenes.front().steps.front().motion, StepMotion::Screw);
  expectFreeWays(parts, plan);
}

// A plate with holes and a stepped pin in each: every pin can only move upwards. With 32 pins across, 1025
// parts, the test passes in 56 s of processor time and 168 MB.
TEST(Plan, PinsByTheHundredLeaveTheirPlate) {
  constexpr int kAcross = 12;
  const Mesh pin =
      test::lathe({{0, -8e-3}, {1.4e-3, -8e-3}, {1.4e-3, 0}, {2e-3, 0}, {2e-3, 2e-3}, {0, 2e-3}}, 24);
  std::vector<DrawnPart> parts = {at("plate", perforatedPlate(kAcross, 5e-3, 1.5e-3, 8e-3), {0, 0, 0})};
  for (int i = 0; i < kAcross * kAcross; ++i)
    parts.push_back(at("pin " + std::to_string(i), pin,
                       5e-3 * Vec3(i % kAcross + 0.5, i / kAcross + 0.5, 0) + Vec3(0, 0, 8e-3)));
  const PlanResult plan = planAssembly("test", parts);
  EXPECT_EQ(plan.blocked(), 0U);
  ASSERT_EQ(plan.assemblies.size(), 1U);
  EXPECT_EQ(plan.assemblies.front().fixed, Names{"plate"});
  ASSERT_EQ(plan.assemblies.front().steps.size(), parts.size() - 1);
  for (const PlannedStep& step : plan.assemblies.front().steps) {
    EXPECT_LT((step.insertion_W + Vec3::UnitZ()).norm(), 1e-9) << step.name;
    EXPECT_TRUE(step.is_carried) << step.name;
  }
}

TEST(Plan, LinksOfAChainAreBlockedByEachOther) {
  const Mesh link = ring(0.02, 0.003);
  const std::vector<DrawnPart> parts = {
      at("one", link, {0, 0, 0}),
      {"two", link, Pose(rotationFromVector({std::numbers::pi / 2, 0, 0}), {0.02, 0, 0}), {}, false},
      at("plate", makeBox(Vec3(0.1, 0.1, 0.01)), {0, 0, -0.04})};
  PlanSettings settings;
  settings.fixed = {"plate"};
  const PlanResult plan = planAssembly("test", parts, settings);
  ASSERT_EQ(plan.assemblies.size(), 2U);  // the links leave the plate as one set, and cannot leave each other
  EXPECT_EQ(plan.assemblies[0].steps.front().parts, (Names{"one", "two"}));
  EXPECT_TRUE(plan.assemblies[0].blocked.empty());
  const PlannedAssembly& links = plan.assemblies[1];
  EXPECT_TRUE(links.steps.empty());
  ASSERT_EQ(links.blocked.size(), 1U);
  EXPECT_EQ(links.blocked.front().by.size(), 1U);
  EXPECT_EQ(plan.blocked(), 1U);
}

TEST(Plan, ABlockUnderARoofSlidesAndThenRises) {
  const std::vector<DrawnPart> parts = {at("housing", roofedBox(), {0, 0, 0}),
                                        at("block", makeBox(Vec3::Constant(0.01)), {0.006, 0, 0.006})};
  const PlanResult plan = planAssembly("test", parts);
  ASSERT_EQ(stepsOf(plan.assemblies.front()), Names{"block"});
  const PlannedStep& step = plan.assemblies.front().steps.front();
  EXPECT_EQ(step.kind, WayKind::Legs);
  ASSERT_EQ(step.before_W.size(), 2U);  // above the opening, then in the opening
  EXPECT_GT(step.before_W[0].p.z(), 0.01);
  EXPECT_GT(step.before_W[1].p.x(), 0.018 - 0.005 + 0.005 - 0.006);
  EXPECT_NEAR(step.before_W[1].p.z(), 0, 1e-6);
  expectFreeWays(parts, plan);
}

// A hand does not follow a wall to the micrometre. The block rises in the middle of an opening that is 0.2 mm
// wider, and at 0.4 mm (a fortieth of its size) from the wall of a wide opening.
TEST(Plan, ABlockRisesWhereItHasRoom) {
  const auto risesAt_m = [](double roof_m) {
    const std::vector<DrawnPart> parts = {at("housing", roofedBox(roof_m), {0, 0, 0}),
                                          at("block", makeBox(Vec3::Constant(0.01)), {0.006, 0, 0.006})};
    const PlanResult plan = planAssembly("test", parts);
    expectFreeWays(parts, plan);
    return plan.assemblies.front().steps.front().before_W.back().p.x();
  };
  EXPECT_NEAR(risesAt_m(0.0248), 0.0239, 10e-6);
  EXPECT_NEAR(risesAt_m(0.02), 0.024 - 0.5 * 0.05 * 0.01 * std::sqrt(3.0), 20e-6);
}

// The roofed box with its opening closed.
TEST(Plan, ABlockInAClosedHousingIsBlocked) {
  Mesh closed = roofedBox();
  append(closed, block({0.015, -0.01, 0.012}, {0.04, 0.01, 0.015}));
  const std::vector<DrawnPart> parts = {at("housing", closed, {0, 0, 0}),
                                        at("block", makeBox(Vec3::Constant(0.01)), {0.006, 0, 0.006})};
  const PlanResult plan = planAssembly("test", parts);
  ASSERT_EQ(plan.assemblies.front().blocked.size(), 1U);
  EXPECT_EQ(plan.assemblies.front().blocked.front().name, "block");
  EXPECT_EQ(plan.assemblies.front().blocked.front().by, Names{"housing"});
}

TEST(Plan, ABayonetTurnsBeforeItLeaves) {
  const std::vector<DrawnPart> parts = {at("socket", bayonetSocket(), {0, 0, 0}),
                                        at("plug", bayonetPlug(), {0, 0, 0})};
  PlanSettings settings;
  settings.fixed = {"socket"};
  const PlanResult plan = planAssembly("test", parts, settings);
  ASSERT_EQ(stepsOf(plan.assemblies.front()), Names{"plug"});
  const PlannedStep& step = plan.assemblies.front().steps.front();
  EXPECT_EQ(step.kind, WayKind::Legs);
  double turned_rad = 0;
  for (const Pose& X_W : step.before_W) turned_rad = std::max(turned_rad, rotationVector(X_W.R).norm());
  EXPECT_GT(turned_rad, 0.7);
  expectFreeWays(parts, plan);
}

// The tongue of one part is in the groove of the other, and walls keep them from parting, so they are
// inserted as one.
TEST(Plan, PartsThatLockEachOtherInAPocketAreASubassembly) {
  const std::vector<DrawnPart> parts = {at("pocket", pocket(), {0, 0, 0}), at("left", tongue(), {0, 0, 0}),
                                        at("right", grooved(), {0, 0, 0})};
  PlanSettings settings;
  settings.fixed = {"pocket"};
  const PlanResult plan = planAssembly("test", parts, settings);
  ASSERT_EQ(plan.assemblies.size(), 2U);
  const PlannedStep& step = plan.assemblies[0].steps.front();
  EXPECT_EQ(step.parts, (Names{"left", "right"}));
  EXPECT_LT((step.insertion_W - Vec3(0, 0, -1)).norm(), 1e-9);
  ASSERT_EQ(plan.assemblies[1].steps.size(), 1U);
  EXPECT_NEAR(std::abs(plan.assemblies[1].steps.front().insertion_W.x()), 1, 1e-9);
  EXPECT_EQ(plan.blocked(), 0U);
  expectFreeWays(parts, plan);
}

TEST(Plan, AnOverlapAsDrawnIsReportedAndHoldsNothingBack) {
  const std::vector<DrawnPart> parts = {at("block", blindHole(), {0, 0, 0}),
                                        at("peg", makeCylinder(4.1e-3, 0.02, 96), {0, 0, 0.01})};
  const PlanResult plan = planAssembly("test", parts);
  ASSERT_EQ(plan.overlaps.size(), 1U);
  EXPECT_NEAR(plan.overlaps.front().interference_depth_m, 0.08e-3, 0.01e-3);
  ASSERT_EQ(stepsOf(plan.assemblies.front()), Names{"peg"});
  EXPECT_LT((plan.assemblies.front().steps.front().insertion_W + Vec3::UnitZ()).norm(), 1e-6);
}

TEST(Plan, OnePartNeedsNoStepsAndNoPartsAreRefused) {
  const PlanResult plan = planAssembly("test", {at("block", makeBox(Vec3::Ones()), {0, 0, 0})});
  EXPECT_EQ(plan.steps() + plan.blocked(), 0U);
  EXPECT_THROW(planAssembly("test", std::vector<DrawnPart>()), LoadError);
  PlanSettings settings;
  settings.fixed = {"nobody"};
  EXPECT_THROW(planAssembly("test", {at("block", makeBox(Vec3::Ones()), {0, 0, 0})}, settings), LoadError);
}

TEST(Plan, AnyNumberOfThreadsGivesTheSamePlan) {
  const std::vector<DrawnPart> parts = {at("pocket", pocket(), {0, 0, 0}), at("left", tongue(), {0, 0, 0}),
                                        at("right", grooved(), {0, 0, 0}),
                                        at("lid", makeBox(Vec3(0.05, 0.05, 0.005)), {0, 0, 0.0325})};
  const auto run = [&](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return planAssembly("test", parts);
  };
  const PlanResult one = run(1), four = run(4);
  EXPECT_EQ(planDot(one), planDot(four));
  for (std::size_t a = 0; a < one.assemblies.size(); ++a)
    for (std::size_t i = 0; i < one.assemblies[a].steps.size(); ++i)
      EXPECT_EQ(one.assemblies[a].steps[i].before_W.front().p,
                four.assemblies[a].steps[i].before_W.front().p);
}

TEST(Plan, ContactsSayWhoTouchesWhomAndWhatStopsWhat) {
  const Mesh cube = makeBox(Vec3::Constant(0.02));
  const PlanResult plan =
      planAssembly("test", {at("left", cube, {-0.03, 0, 0.015}), at("right", cube, {0.03, 0, 0.015}),
                            at("plate", makeBox(Vec3(0.1, 0.1, 0.01)), {0, 0, 0})});
  ASSERT_EQ(plan.contacts.size(), 2U);  // the cubes are 40 mm apart and form no pair
  for (const PlannedContact& contact : plan.contacts) {
    EXPECT_EQ(contact.b, "plate");
    EXPECT_EQ(contact.state, PairState::Contact);
    // Of the six directions of the world's axes, the plate stops a cube only downwards.
    ASSERT_EQ(contact.blocked_W.size(), 1U);
    EXPECT_EQ(contact.blocked_W.front(), Vec3(0, 0, -1));
    EXPECT_EQ(contact.free_W.size(), 5U);
  }
  ASSERT_EQ(plan.equal.size(), 1U);
  EXPECT_EQ(plan.equal.front().names, (Names{"left", "right"}));
}

TEST(Plan, ItsPictureHasEachStepRightOfWhatComesBefore) {
  const std::vector<DrawnPart> parts = {at("core <1>", makeBox(Vec3::Constant(0.008)), {0, 0, 0.007}),
                                        at("cup 2", cup(0.02, 0.001), {0, 0, 0.002}),
                                        at("cup 1", cup(0.01, 0.0005), {0, 0, 0.003})};
  const std::string svg = planSvg(planAssembly("cups & core", parts));
  double last = -1;
  for (const char* name : {">cup 2<", ">1 cup 1<", ">2 core &lt;1&gt;<"}) {
    const std::size_t text = svg.find(name);
    ASSERT_NE(text, std::string::npos) << name << "\n" << svg;
    const double x = std::stod(svg.substr(svg.rfind("<text x='", text) + 9));
    EXPECT_GT(x, last) << name;
    last = x;
  }
  EXPECT_NE(svg.find("cups &amp; core"), std::string::npos);
}

TEST(Plan, StoppedInTheMiddleAndGoneOnWithIsTheSame) {
  const std::vector<DrawnPart> parts = {
      at("core", makeBox(Vec3::Constant(0.008)), {0, 0, 0.007}), at("cup 2", cup(0.02, 0.001), {0, 0, 0.002}),
      at("cup 3", cup(0.03, 0.001), {0, 0, 0.001}), at("cup 1", cup(0.01, 0.0005), {0, 0, 0.003}),
      at("cup 4", cup(0.04, 0.001), {0, 0, 0})};
  struct Stop {};
  PlanFindings found;
  PlanSettings settings;
  settings.found = &found;
  const auto stopsLate = [&](std::string_view, double) {
    if (found.taken_off.size() == 2) throw Stop();
  };
  EXPECT_THROW(planAssembly("test", parts, settings, stopsLate), Stop);
  EXPECT_EQ(found.taken_off, (Names{"core", "cup 1"}));
  EXPECT_FALSE(found.motions.empty());

  const PlanFindings stopped = found;
  settings.known = &stopped;
  const PlanResult resumed = planAssembly("test", parts, settings), whole = planAssembly("test", parts);
  EXPECT_EQ(planDot(resumed), planDot(whole));
  ASSERT_EQ(stepsOf(resumed.assemblies.front()), stepsOf(whole.assemblies.front()));
  for (std::size_t i = 0; i < whole.assemblies.front().steps.size(); ++i)
    EXPECT_EQ(resumed.assemblies.front().steps[i].before_W.front().p,
              whole.assemblies.front().steps[i].before_W.front().p);
  // The known answers are used: with answers that say that nothing stops anything, all parts leave upwards at
  // once.
  PlanFindings wrong = found;
  for (std::uint64_t& one : wrong.motions) one &= ~std::uint64_t{3};
  settings.known = &wrong;
  EXPECT_NE(planDot(planAssembly("test", parts, settings)), planDot(whole));
}

TEST(CheckWays, AWayThroughAWallThinnerThanAnyStepIsNamed) {
  // The wall is 0.1 mm thick. The path is 1 m long with 24 poses 42 mm apart, and the block is 20 mm long.
  const std::vector<DrawnPart> parts = {at("block", makeBox(Vec3::Constant(0.02)), {0, 0, 0.015}),
                                        at("plate", makeBox(Vec3(0.1, 0.1, 0.01)), {0, 0, 0}),
                                        at("wall", makeBox(Vec3(0.2, 0.2, 1e-4)), {0, 0, 0.07})};
  PlanSettings settings;
  settings.fixed = {"plate", "wall"};
  Scene scene = plannedScenes(sceneOf(parts), planAssembly("test", parts, settings)).front();
  SceneStep& step = scene.steps.front();
  step.way_points.clear();
  for (const double turn_rad : {0.0, 1.0}) {
    step.X_WP_start = Pose(rotationFromVector(Vec3(0, 0, turn_rad)), Vec3(0, 0, 1.015));
    const std::vector<WayFault> faults = checkWays(scene);
    ASSERT_EQ(faults.size(), 1U) << turn_rad;
    EXPECT_EQ(faults.front().kind, WayFaultKind::Through);
    EXPECT_EQ(faults.front().against, "wall");
    EXPECT_NEAR(faults.front().depth_m, 50e-6, 2e-6);  // the greatest depth, in the middle of the wall
  }
}

// The block is let down 10 um and a little more into the plate on its way, where 10 um are allowed.
TEST(CheckWays, ADepthBeyondTheAllowedOneByLessThanTheErrorIsNoFault) {
  const std::vector<DrawnPart> parts = {at("block", makeBox(Vec3::Constant(0.02)), {0, 0, 0.015}),
                                        at("plate", makeBox(Vec3(0.1, 0.1, 0.01)), {0, 0, 0})};
  PlanSettings settings;
  settings.fixed = {"plate"};
  Scene scene = plannedScenes(sceneOf(parts), planAssembly("test", parts, settings)).front();
  SceneStep& step = scene.steps.front();
  step.X_WP_start.p = Vec3(0, 0, 0.05);
  for (const auto& [beyond_m, faults] : {std::pair{0.1e-6, 0U}, std::pair{0.4e-6, 1U}}) {
    step.way_points = {Pose::translation(Vec3(0, 0, 0.015 - 10e-6 - beyond_m))};
    EXPECT_EQ(checkWays(scene).size(), faults) << beyond_m;
  }
}

// What nothing proves is no "blocked" for a program that reads the plan.
TEST(PlanFields, OnlyAPartThatIsProvenToHaveNoPathIsBlocked) {
  PlannedAssembly assembly;
  assembly.blocked.resize(2);
  assembly.blocked[0].name = "ball";
  assembly.blocked[0].enclosed_by = "shell";
  assembly.blocked[1].name = "cube";
  const auto namesIn = [&](std::string_view key) {
    std::vector<std::string> names;
    forEachRow(kPlannedAssemblyFields, [&](const auto& row) {
      if constexpr (requires { std::invoke(row.get, assembly).front().enclosed_by; })
        if (row.key == key)
          for (const BlockedPart& part : std::invoke(row.get, assembly)) names.push_back(part.name);
    });
    return names;
  };
  EXPECT_EQ(namesIn("blocked"), std::vector<std::string>{"ball"});
  EXPECT_EQ(namesIn("not_found"), std::vector<std::string>{"cube"});
}

TEST(CheckWays, AnOrderASupportAndAClearanceThatAreLostAreNamed) {
  const std::vector<DrawnPart> parts = {at("core", makeBox(Vec3::Constant(0.006)), {0, 0, 0.004}),
                                        at("cup", cup(0.01, 0.001), {0, 0, 0.001}),
                                        at("lid", makeBox(Vec3(0.02, 0.02, 0.002)), {0, 0, 0.02})};
  Scene scene = plannedScenes(sceneOf(parts), planAssembly("test", parts)).front();
  for (const WayFault& fault : checkWays(scene)) ADD_FAILURE() << toText(fault.kind) << " " << fault.part;

  ASSERT_EQ(scene.steps.size(), 2U);
  Scene swapped = scene;
  std::swap(swapped.steps[0], swapped.steps[1]);
  const std::vector<WayFault> order = checkWays(swapped);
  ASSERT_FALSE(order.empty());
  EXPECT_EQ(order.front().kind, WayFaultKind::Order);
  EXPECT_EQ(order.front().part, "core");
  EXPECT_EQ(order.front().against, "lid");

  Scene loose = scene;
  for (SceneStep& step : loose.steps) step.is_held = false;  // the lid is not carried by anything
  const std::vector<WayFault> support = checkWays(loose);
  ASSERT_EQ(support.size(), 1U);
  EXPECT_EQ(support.front().kind, WayFaultKind::Support);
  EXPECT_EQ(support.front().part, "lid");
}

TEST(CheckWays, AClearanceThatIsLessThanPlannedIsNamed) {
  const std::vector<DrawnPart> parts = {at("block", makeBox(Vec3::Constant(0.02)), {0, 0, 0.015}),
                                        at("plate", makeBox(Vec3(0.1, 0.1, 0.01)), {0, 0, 0}),
                                        at("post", makeBox(Vec3(0.01, 0.01, 0.1)), {0.018, 0, 0.055})};
  PlanSettings settings;
  settings.fixed = {"plate", "post"};
  Scene scene = plannedScenes(sceneOf(parts), planAssembly("test", parts, settings)).front();
  ASSERT_EQ(scene.steps.size(), 1U);
  const std::map<std::string, double> planned = {{"block", 3e-3}};  // the distance from x = 10 to 13 mm
  EXPECT_TRUE(checkWays(scene, {}, planned).empty());
  scene.steps.front().X_WP_start.p.x() += 1e-3;
  const std::vector<WayFault> faults = checkWays(scene, {}, planned);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults.front().kind, WayFaultKind::Clearance);
  EXPECT_EQ(faults.front().against, "post");
  EXPECT_NEAR(faults.front().clearance_m, 2e-3, 3e-6);
  EXPECT_EQ(faults.front().planned_m, 3e-3);
}

// The block moves at 45 degrees to the upper left. The block's upper right edge (x = 10, z = 25 mm) passes
// the lower left edge of the post at a distance of 3 mm, halfway along the path.
TEST(CheckWays, TheLeastClearanceOfAStraightWayIsFoundBetweenItsEnds) {
  const double sum_m = 35e-3 + 3e-3 * std::sqrt(2.0),
               difference_m = 75e-3;  // z + x and z - x of the post's edge
  const Vec3 edge(0.5 * (sum_m - difference_m), 0, 0.5 * (sum_m + difference_m));
  const std::vector<DrawnPart> parts = {
      at("block", makeBox(Vec3::Constant(0.02)), {0, 0, 0.015}),
      at("plate", makeBox(Vec3(0.1, 0.1, 0.01)), {0, 0, 0}),
      at("post", makeBox(Vec3(0.02, 0.1, 0.02)), edge + Vec3(0.01, 0, 0.01))};
  PlanSettings settings;
  settings.fixed = {"plate", "post"};
  Scene scene = plannedScenes(sceneOf(parts), planAssembly("test", parts, settings)).front();
  ASSERT_EQ(scene.steps.size(), 1U);
  SceneStep& step = scene.steps.front();
  step.way_points.clear();
  step.X_WP_start = step.X_WP_target;
  step.X_WP_start.p += Vec3(-0.06, 0, 0.06);
  const std::vector<WayFault> faults = checkWays(scene, {}, {{"block", 4e-3}});
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults.front().kind, WayFaultKind::Clearance);
  EXPECT_EQ(faults.front().against, "post");
  EXPECT_NEAR(faults.front().clearance_m, 3e-3, 3e-6);  // measured to within a thousandth
}

TEST(CheckWays, AWayThroughAWallIsNamedWithItsDepth) {
  const std::vector<DrawnPart> parts = {at("block", makeBox(Vec3::Constant(0.02)), {0, 0, 0.015}),
                                        at("plate", makeBox(Vec3(0.1, 0.1, 0.01)), {0, 0, 0})};
  Scene scene = plannedScenes(sceneOf(parts), planAssembly("test", parts)).front();
  EXPECT_TRUE(checkWays(scene).empty());
  scene.steps.front().X_WP_start.p.z() -= 0.0603;  // the path now comes from below, through the plate
  const std::vector<WayFault> faults = checkWays(scene);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults.front().part, "block");
  EXPECT_EQ(faults.front().against, "plate");
  EXPECT_NEAR(faults.front().depth_m, 0.005,
              0.6e-3);  // in the middle of the 10 mm thick plate, at one of 24 poses
}

// A lid closes the nut, so that the cap can leave in one direction only.
TEST(Plan, AThreadedCapTurnsOffItsNeck) {
  test::ThreadShape neck;
  neck.clearance_m = 0;
  neck.columns = 48;
  neck.rows_per_pitch = 16;
  neck.length_m = 6 * neck.pitch_m;
  test::ThreadShape thread = neck;
  thread.clearance_m = 0.1e-3;
  Mesh cap = test::makeNut(thread, 0.011);
  const double top_m = bounds(cap).max.z();
  append(cap, transformed(makeCylinder(0.01, 3e-3, 48), Pose::translation({0, 0, top_m + 1e-3})));
  const std::vector<DrawnPart> parts = {at("neck", test::makeThreadedRod(neck), {0, 0, -neck.pitch_m}),
                                        at("cap", cap, {0, 0, 0})};
  PlanSettings settings;
  settings.fixed = {"neck"};
  const PlanResult plan = planAssembly("test", parts, settings);
  ASSERT_EQ(stepsOf(plan.assemblies.front()), Names{"cap"});
  const PlannedStep& step = plan.assemblies.front().steps.front();
  EXPECT_EQ(step.kind, WayKind::Screw);
  EXPECT_NEAR(step.lead_m, neck.pitch_m, 1e-6);
  EXPECT_NEAR(step.insertion_W.z(), -1, 1e-6);
  expectFreeWays(parts, plan);
}

/// A blind cap on a threaded neck; the thread's size and length are parameters, and the thread may be shorter
/// or longer than the cap is high.
std::vector<DrawnPart> cappedNeck(double major_m, double pitch_m, double length_m) {
  test::ThreadShape neck;
  neck.major_m = major_m;
  neck.pitch_m = pitch_m;
  neck.length_m = length_m;
  neck.columns = 48;
  neck.rows_per_pitch = 16;
  test::ThreadShape thread = neck;
  thread.clearance_m = 0.06 * pitch_m;
  Mesh cap = test::makeNut(thread, 1.8 * major_m);
  const double top_m = bounds(cap).max.z(), lid_m = 0.4 * major_m;
  append(cap,
         transformed(makeCylinder(1.5 * major_m, lid_m, 48), Pose::translation({0, 0, top_m + 0.5 * lid_m})));
  return {at("neck", test::makeThreadedRod(neck), {0, 0, -pitch_m}), at("cap", cap, {0, 0, 0})};
}

// A screw starts in the orientation of its target, and the hand turns it onto its thread. A start inside the
// thread would overlap it, except at whole turns above the target.
TEST(Plan, AScrewStartsOutsideOfItsThreadHoweverShortItIs) {
  struct Size {
    double major_m, pitch_m, turns;
  };
  for (const Size& size : {Size{2.5e-3, 0.8e-3, 3}, Size{2.5e-3, 0.8e-3, 6}, Size{20e-3, 4.5e-3, 4}}) {
    const std::vector<DrawnPart> parts = cappedNeck(size.major_m, size.pitch_m, size.turns * size.pitch_m);
    PlanSettings settings;
    settings.fixed = {"neck"};
    const PlanResult plan = planAssembly("test", parts, settings);
    ASSERT_EQ(stepsOf(plan.assemblies.front()), Names{"cap"}) << size.major_m << ", " << size.turns;
    ASSERT_EQ(plan.assemblies.front().steps.front().kind, WayKind::Screw);
    std::vector<Scene> scenes = plannedScenes(sceneOf(parts), plan);
    const Pose& X_WP = scenes.front().steps.front().X_WP_start;
    EXPECT_GT(X_WP.p.z() + bounds(parts[1].mesh).min.z(), bounds(parts[0].mesh).max.z() - size.pitch_m);
    EXPECT_TRUE(checkWays(scenes.front()).empty());
    // Half a turn above its target, and not turned, the cap overlaps the thread's flanks.
    scenes.front().steps.front().X_WP_start = Pose::translation({0, 0, 1.5 * size.pitch_m});
    const std::vector<WayFault> faults = checkWays(scenes.front());
    ASSERT_EQ(faults.size(), 1U) << size.major_m;
    EXPECT_EQ(faults.front().kind, WayFaultKind::Through);
  }
}

/// A plate with a bore of 10 mm and a pin of 9.9 mm through it, whose head is below the plate.
std::vector<DrawnPart> hangingHead(double head_radius_m, int segments) {
  return {
      at("plate", test::lathe({{5e-3, 0}, {25e-3, 0}, {25e-3, 10e-3}, {5e-3, 10e-3}}, segments), {0, 0, 0}),
      at("pin",
         test::lathe({{0, -6e-3},
                      {head_radius_m, -6e-3},
                      {head_radius_m, -2e-3},
                      {4.95e-3, -2e-3},
                      {4.95e-3, 14e-3},
                      {0, 14e-3}},
                     segments),
         {0, 0, 0})};
}

// Within the allowance for meshes the head passes the bore upwards, the direction that gravity prefers.
TEST(Plan, AHoleThatIsTooSmallByLessThanTheAllowanceIsNotTheWayWhereTheOtherSideIsFree) {
  for (const int segments : {32, 64, 200})
    for (const double too_large_m : {0.5e-6, 2e-6, 5e-6, 8e-6}) {
      PlanSettings settings;
      settings.fixed = {"plate"};
      const PlanResult plan = planAssembly("test", hangingHead(5e-3 + too_large_m, segments), settings);
      ASSERT_EQ(stepsOf(plan.assemblies.front()), Names{"pin"});
      const PlannedStep& step = plan.assemblies.front().steps.front();
      EXPECT_NEAR(step.insertion_W.z(), 1, 1e-6) << segments << ", " << too_large_m;
      EXPECT_EQ(step.allowance_m, 0) << segments << ", " << too_large_m;
    }
}

TEST(Plan, AWayThatNeedsTheAllowanceIsTakenWhereThereIsNoOtherAndIsSaid) {
  // A floor below, also fixed, leaves only the path through the bore.
  std::vector<DrawnPart> parts = hangingHead(5e-3 + 2e-6, 64);
  parts.push_back(at("floor", makeBox({0.05, 0.05, 1e-3}), {0, 0, -6.6e-3}));
  PlanSettings settings;
  settings.fixed = {"plate", "floor"};
  const PlanResult plan = planAssembly("test", parts, settings);
  ASSERT_EQ(stepsOf(plan.assemblies.front()), Names{"pin"});
  const PlannedStep& step = plan.assemblies.front().steps.front();
  EXPECT_NEAR(step.insertion_W.z(), -1, 1e-6);
  EXPECT_GE(step.allowance_m, 2e-6);
}

// The floor carries nothing and can be taken off first; then the pin leaves without an allowance.
TEST(Plan, WhatNeedsTheAllowanceWaitsUntilTheOtherSideIsFree) {
  std::vector<DrawnPart> parts = hangingHead(5e-3 + 2e-6, 64);
  parts.push_back(at("floor", makeBox({0.05, 0.05, 1e-3}), {0, 0, -8.5e-3}));
  PlanSettings settings;
  settings.fixed = {"plate"};
  const PlanResult plan = planAssembly("test", parts, settings);
  ASSERT_EQ(stepsOf(plan.assemblies.front()), (Names{"pin", "floor"}));
  EXPECT_NEAR(plan.assemblies.front().steps.front().insertion_W.z(), 1, 1e-6);
  EXPECT_EQ(plan.assemblies.front().steps.front().allowance_m, 0);
}

/// The plan of a block that is drawn floating above a table.
PlannedStep blockAboveTable(double gap_m) {
  const std::vector<DrawnPart> parts = {at("table", makeBox({0.1, 0.1, 0.01}), {0, 0, -0.005}),
                                        at("block", makeBox({0.02, 0.02, 0.02}), {0, 0, 0.01 + gap_m})};
  PlanSettings settings;
  settings.fixed = {"table"};
  const PlanResult plan = planAssembly("test", parts, settings);
  if (plan.assemblies.front().steps.size() != 1) throw std::runtime_error("no step");
  return plan.assemblies.front().steps.front();
}

// Without a fit a part may be displaced by 0.5 mm.
TEST(Plan, APartThatIsDrawnFloatingIsHeld) {
  EXPECT_TRUE(blockAboveTable(0).is_carried);
  EXPECT_TRUE(blockAboveTable(0.4e-3).is_carried);
  EXPECT_FALSE(blockAboveTable(0.6e-3).is_carried);
  EXPECT_FALSE(blockAboveTable(5e-3).is_carried);
}

}  // namespace
}  // namespace vps::scenes
