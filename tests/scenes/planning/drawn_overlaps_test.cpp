// SPDX-License-Identifier: BSD-3-Clause
// CAD files with typical drawn interferences: the classification of each overlap, and the change that the
// plan makes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/assemblies_to_plan.h"
#include "support/swept.h"
#include "vps_scenes/fits/check.h"
#include "vps_scenes/planning/plan.h"

namespace vps::scenes {
namespace {

const ScenePart& partOf(const Scene& scene, const std::string& name) {
  return *std::ranges::find(scene.parts, name, [](const ScenePart& part) { return part.part.name; });
}

struct Planned {
  PlanResult plan;
  Scene scene;
};
Planned planned(const std::vector<DrawnPart>& parts, const std::string& base) {
  PlanSettings settings;
  settings.fixed = {base};
  Planned out{planAssembly("test", parts, settings), {}};
  out.scene = plannedScenes(sceneOf(parts), out.plan).front();
  for (const WayFault& fault : checkWays(out.scene))
    ADD_FAILURE() << fault.part << " through " << fault.against << " by " << fault.depth_m;
  return out;
}

// An M6 screw in the minor diameter of its thread, 5 mm deep below a plate with a through hole.
TEST(DrawnOverlaps, AScrewInTheMinorDiameterIsAThread) {
  Mesh base = test::lathe({{2.459e-3, -20e-3}, {20e-3, -20e-3}, {20e-3, -5e-3}, {2.459e-3, -5e-3}}, 64);
  const std::vector<DrawnPart> parts = {at("base", base, {0, 0, 0}),
                                        at("plate", makeTube(20e-3, 3.3e-3, 5e-3, 64), {0, 0, -2.5e-3}),
                                        at("screw", headed(3e-3, 15e-3, 5e-3, 6e-3), {0, 0, 0})};
  const auto [plan, scene] = planned(parts, "base");
  ASSERT_EQ(plan.choices.size(), 1U);
  EXPECT_EQ(plan.choices[0].kind, OverlapKind::Thread);
  EXPECT_EQ(plan.choices[0].changed, "screw");
  EXPECT_EQ(plan.blocked(), 0U);
  const PlannedStep& step = plan.assemblies[0].steps.back();
  EXPECT_EQ(step.name, "screw");
  EXPECT_NEAR(step.insertion_W.z(), -1, 1e-6);
  // In the planned scene the screw passes, and its head is unchanged.
  const Scene drawn = sceneOf(parts);
  // The check has the same answer as the plan.
  EXPECT_EQ(checkAssembly("drawn", drawnParts(drawn)).pairs.at(0).state, PairState::Thread);
  EXPECT_EQ(checkAssembly("planned", drawnParts(scene)).clashes(), 0U);
  const Mesh& mesh = partOf(scene, "screw").part.mesh;
  EXPECT_NEAR(bounds(mesh).size().x(), 10e-3, 1e-9);
  EXPECT_NEAR(bounds(mesh).size().z(), 21e-3, 1e-9);
  EXPECT_TRUE(checkMesh(mesh).isClosed());
  EXPECT_NE(partOf(scene, "screw").fastener.find("M6"), std::string::npos);
}

TEST(DrawnOverlaps, ANutWithAPlainHoleIsAThreadAndItsHoleIsWidened) {
  constexpr int kColumns = 96;
  const Mesh nut = test::sweptSections(kColumns, [&](int i) {
    const double angle = test::kTurn_rad * (i % kColumns) / kColumns;
    const double out_m = test::polygonRadius(7.5e-3, 6, angle);
    return std::vector<Vec3>{test::polar(3.324e-3, angle, 0), test::polar(out_m, angle, 0),
                             test::polar(out_m, angle, 6.5e-3), test::polar(3.324e-3, angle, 6.5e-3)};
  });
  const std::vector<DrawnPart> parts = {at("plate", makeTube(20e-3, 4.3e-3, 10e-3, 64), {0, 0, -5e-3}),
                                        at("bolt", headed(4e-3, 25e-3, 6.5e-3, 8e-3), {0, 0, 0}),
                                        at("nut", nut, {0, 0, -16.5e-3})};
  const auto [plan, scene] = planned(parts, "plate");
  ASSERT_EQ(plan.choices.size(), 1U);
  EXPECT_EQ(plan.choices[0].kind, OverlapKind::Thread);
  EXPECT_EQ(plan.choices[0].changed, "nut");
  EXPECT_EQ(plan.blocked(), 0U);
  EXPECT_EQ(checkAssembly("planned", drawnParts(scene)).clashes(), 0U);
  // The bolt is unchanged.
  EXPECT_NEAR(massProperties(partOf(scene, "bolt").part.mesh).volume_m3,
              massProperties(parts[1].mesh).volume_m3, 1e-15);
}

TEST(DrawnOverlaps, ALittleTooLargeIsAPressFit) {
  for (const double too_large_m : {10e-6, 30e-6}) {
    const std::vector<DrawnPart> parts = {
        at("hub", makeTube(15e-3, 5e-3, 20e-3, 96), {0, 0, 0}),
        at("pin", makeCylinder(5e-3 + 0.5 * too_large_m, 30e-3, 96), {0, 0, 0})};
    const auto [plan, scene] = planned(parts, "hub");
    ASSERT_EQ(plan.choices.size(), 1U) << too_large_m;
    EXPECT_EQ(plan.choices[0].kind, OverlapKind::PressFit);
    const ScenePart& pin = partOf(scene, "pin");
    EXPECT_GE(pin.press_fit_m, too_large_m - 1e-9);
    EXPECT_LT(pin.press_fit_m, too_large_m + 5e-6);
    EXPECT_EQ(checkAssembly("planned", drawnParts(scene)).clashes(), 0U);
  }
}

TEST(DrawnOverlaps, MuchTooLargeIsAClash) {
  const std::vector<DrawnPart> parts = {at("hub", makeTube(15e-3, 5e-3, 20e-3, 96), {0, 0, 0}),
                                        at("pin", makeCylinder(5.2e-3, 30e-3, 96), {0, 0, 0})};
  const PlanResult plan = planAssembly("test", parts);
  ASSERT_EQ(plan.choices.size(), 1U);
  EXPECT_EQ(plan.choices[0].kind, OverlapKind::Clash);
  EXPECT_TRUE(plan.choices[0].changed.empty() && plan.choices[0].left_out.empty());
}

// A pin through a collar, a plate and a ring, with holes as wide as the pin; 30 mm long between its ends.
TEST(DrawnOverlaps, AShaftAsWideAsItsHolesIsMadeThinnerOnce) {
  const std::vector<DrawnPart> parts = {at("plate", makeTube(20e-3, 5e-3, 10e-3, 96), {0, 0, 0}),
                                        at("collar", makeTube(9e-3, 5e-3, 5e-3, 96), {0, 0, 7.5e-3}),
                                        at("ring", makeTube(9e-3, 5e-3, 3e-3, 96), {0, 0, -6.5e-3}),
                                        at("pin", headed(5e-3, 25e-3, 8e-3, 6e-3), {0, 0, 10e-3})};
  const auto [plan, scene] = planned(parts, "plate");
  ASSERT_EQ(plan.choices.size(), 1U);
  const OverlapChoice& choice = plan.choices[0];
  EXPECT_EQ(choice.kind, OverlapKind::LineToLine);
  EXPECT_EQ(choice.changed, "pin");
  for (const char* hole : {"'plate'", "'collar'", "'ring'"})
    EXPECT_NE(choice.words.find(hole), std::string::npos) << choice.words;
  EXPECT_EQ(plan.blocked(), 0U);
  const CheckResult checked = checkAssembly("planned", drawnParts(scene));
  ASSERT_EQ(checked.fits.size(), 3U);
  for (const CheckedFit& fit : checked.fits)
    EXPECT_NEAR(fit.diametral_clearance_m, 50e-6, 1e-6) << fit.shaft << " in " << fit.bore;
  // The pin's head and length are unchanged.
  const Vec3 size_m = bounds(partOf(scene, "pin").part.mesh).size();
  EXPECT_NEAR(size_m.x(), 16e-3, 1e-9);
  EXPECT_NEAR(size_m.z(), 31e-3, 1e-9);
  EXPECT_TRUE(checkMesh(partOf(scene, "pin").part.mesh).isClosed());
}

TEST(DrawnOverlaps, AClearanceThatCanBeToldIsKept) {
  const std::vector<DrawnPart> parts = {at("plate", makeTube(20e-3, 5e-3, 10e-3, 96), {0, 0, 0}),
                                        at("pin", makeCylinder(4.999e-3, 30e-3, 96), {0, 0, 0})};
  EXPECT_TRUE(planned(parts, "plate").plan.choices.empty());
}

TEST(DrawnOverlaps, FlatFacesThatCoincideAreNone) {
  const std::vector<DrawnPart> parts = {at("plate", makeBox(Vec3(0.1, 0.1, 0.01)), {0, 0, 0}),
                                        at("a", makeBox(Vec3::Constant(0.02)), {0, 0, 0.015}),
                                        at("b", makeBox(Vec3::Constant(0.02)), {0.02, 0, 0.015})};
  const PlanResult plan = planAssembly("test", parts);
  EXPECT_TRUE(plan.choices.empty());
  EXPECT_EQ(plan.blocked(), 0U);
}

TEST(DrawnOverlaps, OfPartsDrawnTwiceAllButTheFirstAreLeftOut) {
  const Mesh brick = makeBox(Vec3::Constant(0.02));
  const std::vector<DrawnPart> parts = {at("plate", makeBox(Vec3(0.1, 0.1, 0.01)), {0, 0, 0}),
                                        at("one", brick, {0, 0, 0.015}), at("two", brick, {0, 0, 0.015}),
                                        at("three", brick, {0, 0, 0.015})};
  const auto [plan, scene] = planned(parts, "plate");
  EXPECT_EQ(plan.steps(), 1U);
  EXPECT_EQ(plan.blocked(), 0U);
  EXPECT_FALSE(partOf(scene, "one").is_scenery);
  EXPECT_TRUE(partOf(scene, "two").is_scenery);
  EXPECT_TRUE(partOf(scene, "three").is_scenery);
}

// An O-ring of 2 mm, drawn round, in a groove that is 1.5 mm deep below a lid.
TEST(DrawnOverlaps, ASealThatIsDrawnRoundIsLeftOut) {
  const Mesh base = test::lathe({{0, 0},
                                 {20e-3, 0},
                                 {20e-3, 10e-3},
                                 {12e-3, 10e-3},
                                 {12e-3, 8.5e-3},
                                 {9e-3, 8.5e-3},
                                 {9e-3, 10e-3},
                                 {0, 10e-3}},
                                64);
  const std::vector<DrawnPart> parts = {at("base", base, {0, 0, 0}),
                                        at("seal", ring(10.5e-3, 1e-3), {0, 0, 9.5e-3}),
                                        at("lid", makeCylinder(20e-3, 5e-3, 64), {0, 0, 12.5e-3})};
  const auto [plan, scene] = planned(parts, "base");
  ASSERT_EQ(plan.choices.size(), 1U);
  EXPECT_EQ(plan.choices[0].kind, OverlapKind::Flexible);
  EXPECT_EQ(plan.choices[0].left_out, "seal");
  EXPECT_TRUE(partOf(scene, "seal").is_scenery);
  EXPECT_EQ(plan.steps(), 1U);
}

TEST(DrawnOverlaps, APartWithoutVolumeIsLeftOut) {
  Mesh label = block({0, 0, 0.02}, {0.01, 0.01, 0.02});  // flat
  Mesh face;
  face.vertices = {{0.03, 0.03, 0.015}, {0.04, 0.03, 0.015}, {0.03, 0.04, 0.015}};
  face.triangles = {{0, 1, 2}};
  const auto [plan, scene] = planned(
      {at("plate", makeBox(Vec3(0.1, 0.1, 0.01)), {0, 0, 0}), at("label", label, {0, 0, 0}),
       at("face", face, {0, 0, 0}), at("foil", block({0.02, 0, 0.006}, {0.04, 0.01, 0.00601}), {0, 0, 0})},
      "plate");
  ASSERT_EQ(plan.choices.size(), 2U);
  EXPECT_EQ(plan.choices[0].kind, OverlapKind::NoVolume);
  EXPECT_EQ(plan.choices[0].left_out, "label");
  EXPECT_EQ(plan.choices[1].left_out, "face");
  EXPECT_TRUE(partOf(scene, "label").is_scenery);
  EXPECT_TRUE(partOf(scene, "face").is_scenery);
  ASSERT_EQ(plan.steps(), 1U);  // a thickness of 10 um counts as a body
  EXPECT_EQ(plan.assemblies[0].steps[0].name, "foil");
}

TEST(DrawnOverlaps, AThinBracketThatClashesIsNoSeal) {
  Mesh bracket = block({0, 0, 0}, {0.05, 0.02, 0.002});
  append(bracket, block({0, 0, 0}, {0.002, 0.02, 0.05}));
  const PlanResult plan =
      planAssembly("test", {at("base", block({-0.05, -0.05, -0.02}, {0.1, 0.1, 0.001}), {0, 0, 0}),
                            at("bracket", bracket, {0, 0, 0})});
  ASSERT_EQ(plan.choices.size(), 1U);
  EXPECT_EQ(plan.choices[0].kind, OverlapKind::Clash);
}

}  // namespace
}  // namespace vps::scenes
