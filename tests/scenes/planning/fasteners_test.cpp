// SPDX-License-Identifier: BSD-3-Clause
// Fasteners of known kinds and sizes, and parts that are not fasteners.
#include "vps_scenes/fits/fasteners.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "scenes/assemblies_to_plan.h"
#include "support/screw.h"
#include "vps_scenes/planning/plan.h"

namespace vps::scenes {
namespace {

/// A plain hexagonal nut around z.
Mesh plainNut(double hole_m, double corner_m, double height_m) {
  constexpr int kColumns = 96;
  return test::sweptSections(kColumns, [&](int i) {
    const double angle = test::kTurn_rad * (i % kColumns) / kColumns;
    const double out_m = test::polygonRadius(corner_m, 6, angle);
    return std::vector<Vec3>{test::polar(hole_m, angle, 0), test::polar(out_m, angle, 0),
                             test::polar(out_m, angle, height_m), test::polar(hole_m, angle, height_m)};
  });
}

/// The description of each part; "" if it is not a fastener.
std::map<std::string, std::string> wordsOf(const std::vector<DrawnPart>& parts) {
  std::map<std::string, std::string> out;
  for (const DrawnPart& part : parts) out[part.name] = "";
  for (const Fastener& one : findFasteners(parts)) out[one.part] = one.words;
  return out;
}

TEST(Fasteners, AreNamedWithTheirSizes) {
  // Position and orientation of the fasteners are arbitrary.
  const Pose X_W(rotationFromVector({0.3, -1.1, 0.4}), {0.1, 0.2, -0.3});
  std::vector<DrawnPart> parts = {at("bolt", headed(4e-3, 30e-3, 6.5e-3, 8e-3), {0, 0, 0}),
                                  at("nut", plainNut(3.324e-3, 7.5e-3, 6.5e-3), {0, 0, 0}),
                                  at("washer", makeTube(8e-3, 4.2e-3, 1.6e-3, 64), {0, 0, 0}),
                                  at("pin", makeCylinder(3e-3, 20e-3, 48), {0, 0, 0}),
                                  at("clip", ringPiece(9e-3, 11e-3, 0, 1e-3, 20, 340), {0, 0, 0})};
  for (DrawnPart& part : parts) part.X_WP = X_W;
  std::map<std::string, std::string> words = wordsOf(parts);
  EXPECT_EQ(words["bolt"], "headed pin 8 x 30 mm (if threaded, M8)");
  EXPECT_EQ(words["nut"], "nut for M8");
  EXPECT_EQ(words["washer"], "washer 8.4 x 16 x 1.6 mm");
  EXPECT_EQ(words["pin"], "pin 6 x 20 mm");
  EXPECT_EQ(words["clip"], "circlip 18 x 22 x 1 mm");
}

// Widths across flats and heights of DIN 985 (M10 and M12 are wider than in ISO 4032), threads of ISO 262.
TEST(Fasteners, ALockNutIsNamedByItsHoleAndItsWidthAcrossFlats) {
  struct Nut {
    double size_mm, pitch_mm, across_mm, height_mm;
  };
  for (const Nut& nut : {Nut{3, 0.5, 5.5, 4}, Nut{4, 0.7, 7, 5}, Nut{5, 0.8, 8, 5}, Nut{6, 1, 10, 6},
                         Nut{8, 1.25, 13, 8}, Nut{10, 1.5, 17, 10}, Nut{12, 1.75, 19, 12}}) {
    const double corner_m = 1e-3 * nut.across_mm / std::sqrt(3.0);
    // The hole is drawn with the major diameter, the minor diameter or that of the drill.
    for (const double below : {0.0, 1.0825, 1.0}) {
      const double hole_m = 0.5e-3 * (nut.size_mm - below * nut.pitch_mm);
      std::map<std::string, std::string> words =
          wordsOf({at("nut", plainNut(hole_m, corner_m, 1e-3 * nut.height_mm), {0, 0, 0})});
      EXPECT_EQ(words["nut"], "nut for M" + std::to_string(std::lround(nut.size_mm))) << below;
    }
  }
}

/// A shank with a hexagonal head around z.
Mesh hexagonScrew(double shank_m, double length_m, double corner_m, double height_m) {
  constexpr int kColumns = 96;
  return test::sweptSections(kColumns, [&](int i) {
    const double angle = test::kTurn_rad * (i % kColumns) / kColumns;
    const double out_m = test::polygonRadius(corner_m, 6, angle);
    return std::vector<Vec3>{test::polar(0, angle, 0),
                             test::polar(shank_m, angle, 0),
                             test::polar(shank_m, angle, length_m),
                             test::polar(out_m, angle, length_m),
                             test::polar(out_m, angle, length_m + height_m),
                             test::polar(0, angle, length_m + height_m)};
  });
}

TEST(Fasteners, AStepWithoutThreadAndDriveIsNoScrew) {
  const std::vector<DrawnPart> parts = {at("screw", hexagonScrew(4e-3, 30e-3, 7.5e-3, 5.3e-3), {0, 0, 0}),
                                        at("probe", headed(8.545e-3, 40e-3, 14e-3, 12e-3), {0, 0, 0}),
                                        at("clevis", headed(2e-3, 17.09e-3, 4e-3, 3e-3), {0, 0, 0}),
                                        at("twice stepped",
                                           test::lathe({{0, 0},
                                                        {2e-3, 0},
                                                        {2e-3, 10e-3},
                                                        {3e-3, 10e-3},
                                                        {3e-3, 14e-3},
                                                        {4e-3, 14e-3},
                                                        {4e-3, 17e-3},
                                                        {0, 17e-3}},
                                                       96),
                                           {0, 0, 0})};
  std::map<std::string, std::string> words = wordsOf(parts);
  EXPECT_EQ(words["screw"], "screw M8 x 30, hexagon head");
  EXPECT_EQ(words["probe"], "");
  EXPECT_EQ(words["clevis"], "headed pin 4 x 17.09 mm (if threaded, M4)");
  EXPECT_EQ(words["twice stepped"], "");
}

TEST(Fasteners, ThreadsGiveTheirStandardSize) {
  test::ThreadShape thread{.major_m = 5e-3, .pitch_m = 1.5e-3, .length_m = 12e-3, .columns = 96};
  Mesh screw = test::makeThreadedRod(thread);
  std::map<std::string, std::string> words = wordsOf({at("rod", screw, {0, 0, 0})});
  EXPECT_EQ(words["rod"], "stud M10 x 12");
  thread.clearance_m = 0;
  EXPECT_EQ(wordsOf({at("nut", test::makeNut(thread, 9.2e-3), {0, 0, 0})})["nut"], "nut M10");
}

TEST(Fasteners, OtherPartsAreNone) {
  const std::vector<DrawnPart> parts = {at("box", makeBox(Vec3(0.01, 0.02, 0.03)), {0, 0, 0}),
                                        at("housing", makeTube(30e-3, 10e-3, 40e-3, 96), {0, 0, 0}),
                                        at("bush", makeTube(8e-3, 6e-3, 12e-3, 64), {0, 0, 0}),
                                        at("disc", makeCylinder(30e-3, 10e-3, 96), {0, 0, 0}),
                                        at("rope", makeCylinder(2e-3, 300e-3, 48), {0, 0, 0}),
                                        at("ball", makeSphere(5e-3, 3), {0, 0, 0}),
                                        at("plate", perforatedPlate(2, 20e-3, 4e-3, 5e-3), {0, 0, 0}),
                                        at("stepped",
                                           test::lathe({{0, 0},
                                                        {4e-3, 0},
                                                        {4e-3, 10e-3},
                                                        {6e-3, 10e-3},
                                                        {6e-3, 20e-3},
                                                        {3e-3, 20e-3},
                                                        {3e-3, 40e-3},
                                                        {0, 40e-3}},
                                                       64),
                                           {0, 0, 0})};
  for (const auto& [name, words] : wordsOf(parts)) EXPECT_EQ(words, "") << name;
}

TEST(Fasteners, AKeyIsABarBetweenTwoParts) {
  // A shaft and a hub, each with a slot, made of boxes.
  Mesh shaft = block({-0.01, -0.02, -0.02}, {0.01, 0.02, -0.003});
  append(shaft, block({-0.01, -0.02, -0.003}, {-0.003, 0.02, 0}));
  append(shaft, block({0.003, -0.02, -0.003}, {0.01, 0.02, 0}));
  Mesh hub = block({-0.01, -0.02, 0.003}, {0.01, 0.02, 0.02});
  append(hub, block({-0.01, -0.02, 0}, {-0.00301, 0.02, 0.003}));
  append(hub, block({0.00301, -0.02, 0}, {0.01, 0.02, 0.003}));
  const PlanResult plan =
      planAssembly("test", {at("shaft", shaft, {0, 0, 0}), at("hub", hub, {0, 0, 0}),
                            at("key", block({-0.003, -0.01, -0.003}, {0.003, 0.01, 0.003}), {0, 0, 0})});
  ASSERT_EQ(plan.fasteners.size(), 1U);
  EXPECT_EQ(plan.fasteners[0].part, "key");
  EXPECT_EQ(plan.fasteners[0].words, "key 6 x 6 x 20 mm");
}

TEST(Fasteners, APinIsOneOnlyWhereItFits) {
  const std::vector<DrawnPart> fitted = {at("block", blindHole(), {0, 0, 0}),
                                         at("peg", makeCylinder(4e-3, 0.02, 96), {0, 0, 0.01})};
  EXPECT_EQ(planAssembly("test", fitted).fasteners.size(), 1U);
  const std::vector<DrawnPart> loose = {at("block", makeBox(Vec3::Constant(0.05)), {0, 0, -0.025}),
                                        at("peg", makeCylinder(4e-3, 0.02, 96), {0, 0, 0.01})};
  EXPECT_TRUE(planAssembly("test", loose).fasteners.empty());
}

}  // namespace
}  // namespace vps::scenes
