// SPDX-License-Identifier: BSD-3-Clause
// Checks of chosen pairs, and of parts that are moved first.
#include <gtest/gtest.h>

#include <numbers>

#include "scenes/drawn_part.h"
#include "vps/errors.h"
#include "vps_scenes/fits/check.h"
#include "vps_scenes/fits/part_moves.h"

namespace vps::scenes {
namespace {

/// A block of 10 mm along x, with a square section.
DrawnPart blockAt(const std::string& name, double x_m, double side_m,
                  const std::vector<std::string>& within = {}) {
  DrawnPart out = part(name, makeBox({10e-3, side_m, side_m}), Pose::translation({x_m, 0, 0}));
  out.within = within;
  return out;
}

/// Three blocks in a row: a and b overlap by 2 mm and b and c by 3 mm, more than any place near the drawn one
/// clears.
std::vector<DrawnPart> row() {
  return {blockAt("a", 0, 10e-3), blockAt("b", 8e-3, 8e-3, {"valve"}), blockAt("c", 15e-3, 6e-3, {"valve"})};
}

CheckResult checkPairsOf(const std::vector<DrawnPart>& parts, const std::vector<PairPattern>& between,
                         const std::vector<PairPattern>& ignored, bool has_play = false) {
  CheckSettings settings;
  settings.has_play = has_play;
  settings.has_places = true;
  settings.between = between;
  settings.ignored = ignored;
  return checkAssembly("row", parts, settings);
}

TEST(ChosenPairs, OnlyTheAskedPairsAreMeasured) {
  EXPECT_EQ(checkPairsOf(row(), {}, {}).clashes(), 2U);
  const CheckResult found = checkPairsOf(row(), {{"a", "*", "--between a,*"}}, {});
  ASSERT_EQ(found.pairs.size(), 1U);
  EXPECT_EQ(found.pairs[0].a, "a");
  EXPECT_EQ(found.pairs[0].b, "b");
  ASSERT_EQ(found.left_out.size(), 1U);
  EXPECT_EQ(found.left_out[0].a, "b");
  EXPECT_EQ(found.left_out[0].b, "c");
  EXPECT_FALSE(found.left_out[0].is_ignored);
  EXPECT_TRUE(found.isAboutChosenPairs());
}

TEST(ChosenPairs, ThePartsOfAnAssemblyAreChosenByItsName) {
  const CheckResult found = checkPairsOf(row(), {{"valve", "valve", "--between valve,valve"}}, {});
  ASSERT_EQ(found.pairs.size(), 1U);
  EXPECT_EQ(found.pairs[0].a, "b");
  EXPECT_EQ(found.pairs[0].b, "c");
}

TEST(ChosenPairs, AnIgnoredOverlapIsNoClash) {
  const std::vector<DrawnPart> parts{blockAt("a", 0, 10e-3), blockAt("b", 8e-3, 8e-3),
                                     blockAt("c", 18.02e-3, 6e-3)};
  EXPECT_NE(checkPairsOf(parts, {}, {}).verdict(), Verdict::Fits);
  const CheckResult found = checkPairsOf(parts, {}, {{"b", "a", "--ignore b,a"}}, true);
  EXPECT_EQ(found.verdict(), Verdict::Fits);
  ASSERT_EQ(found.pairs.size(), 1U);
  EXPECT_NEAR(found.pairs[0].clearance_m, 20e-6, 1e-9);
  ASSERT_EQ(found.left_out.size(), 1U);
  EXPECT_TRUE(found.left_out[0].is_ignored);
  EXPECT_EQ(found.left_out[0].reason, "--ignore b,a");
  EXPECT_FALSE(found.parts[0].play);  // how far a and b move in each other is not known
  EXPECT_FALSE(found.parts[1].play);
  EXPECT_TRUE(found.parts[2].play);
}

// The overlap of 20 um of b and c is cleared although b stays inside a.
TEST(ChosenPairs, TheSearchForPlacesDoesNotLookAtIgnoredPairs) {
  const std::vector<DrawnPart> parts{blockAt("a", 0, 10e-3), blockAt("b", 8e-3, 8e-3),
                                     blockAt("c", 17.98e-3, 6e-3)};
  const CheckResult found = checkPairsOf(parts, {}, {{"a", "b", "--ignore a,b"}});
  EXPECT_EQ(found.clashes(), 1U);
  EXPECT_EQ(found.verdict(), Verdict::Fits) << found.places.reason;
  EXPECT_FALSE(found.places.moved.empty());
}

TEST(ChosenPairs, NothingIsShownIfAllPairsAreIgnored) {
  const CheckResult found = checkPairsOf(row(), {}, {{"*", "*", "--ignore *,*"}});
  EXPECT_TRUE(found.isAllIgnored());
  EXPECT_TRUE(found.alone.empty());
  EXPECT_EQ(found.verdict(), Verdict::NotShown);
}

TEST(ChosenPairs, AskedPartsThatAreFarApartDoNotOverlap) {
  const std::vector<DrawnPart> parts{blockAt("a", 0, 10e-3), blockAt("b", 0.1, 8e-3),
                                     blockAt("c", 0.109, 6e-3)};
  const CheckResult found = checkPairsOf(parts, {{"a", "b", "--between a,b"}}, {});
  EXPECT_TRUE(found.pairs.empty());
  EXPECT_TRUE(found.alone.empty());
  EXPECT_EQ(found.verdict(), Verdict::Fits);
}

TEST(ChosenPairs, APatternWithoutAPartIsRefused) {
  EXPECT_THROW(checkPairsOf(row(), {{"a", "d", "--between a,d"}}, {}), LoadError);
  EXPECT_THROW(checkPairsOf(row(), {}, {{"a", "a", "--ignore a,a"}}), LoadError);
}

TEST(PartMoves, AreReadFromText) {
  PartMove move = partMoveFromText("pin, left,-0.5:0:0,0.1mm", "--move");
  EXPECT_EQ(move.part, "pin, left");
  EXPECT_NEAR((move.axis_W + Vec3::UnitX()).norm(), 0, 1e-15);
  EXPECT_NEAR(move.by_m, 0.1e-3, 1e-15);
  EXPECT_EQ(move.turn_rad, 0);
  move = partMoveFromText("pin,rz,-90deg", "--move");
  EXPECT_EQ(move.axis_W, Vec3::UnitZ());
  EXPECT_EQ(move.by_m, 0);
  EXPECT_NEAR(move.turn_rad, -std::numbers::pi / 2, 1e-15);
  EXPECT_NEAR(partMoveFromText("pin,r0:3:4,0.1rad", "--move").axis_W.z(), 0.8, 1e-15);
  for (const char* text :
       {"", "pin", "pin,x", ",x,1mm", "pin,w,1mm", "pin,0:0:0,1mm", "pin,1:0,1mm", "pin,1:0:0:0,1mm",
        "pin,x,1", "pin,x,2deg", "pin,rx,1mm", "pin,rx,2", "pin,x,nanmm"})
    EXPECT_THROW(partMoveFromText(text, "--move"), LoadError) << text;
}

TEST(PartMoves, AMovedPartIsCheckedAtItsNewPlace) {
  std::vector<DrawnPart> parts{blockAt("a", 0, 10e-3), blockAt("b", 10.02e-3, 8e-3)};
  moveParts(parts, {partMoveFromText("b,x,0.1mm", "--move"), partMoveFromText("b,x,10um", "--move")},
            "--move");
  const CheckResult found = checkPairsOf(parts, {}, {});
  ASSERT_EQ(found.pairs.size(), 1U);
  EXPECT_NEAR(found.pairs[0].clearance_m, 130e-6, 1e-12);
  ASSERT_EQ(found.moves.size(), 2U);
  EXPECT_EQ(found.moves[0].part, "b");
  EXPECT_NEAR(found.moves[0].by_m, 0.1e-3, 1e-15);
}

TEST(PartMoves, ARotationIsAboutThePartsOwnOrigin) {
  // A quarter of a turn about z through (3, 0, 0) takes x to y.
  std::vector<DrawnPart> parts{blockAt("a", 3, 10e-3)};
  moveParts(parts, {partMoveFromText("a,rz,90deg", "--move")}, "--move");
  EXPECT_NEAR((parts[0].X_WP * Vec3::UnitX() - Vec3(3, 1, 0)).norm(), 0, 1e-15);
}

TEST(PartMoves, AnUnknownPartIsNamedWithTheNearestName) {
  std::vector<DrawnPart> parts{blockAt("bracket", 0, 10e-3)};
  try {
    moveParts(parts, {partMoveFromText("braket,x,1mm", "--move")}, "--move");
    FAIL() << "accepted";
  } catch (const LoadError& error) {
    EXPECT_STREQ(error.what(), "--move: 'braket' is not the name of a part; did you mean 'bracket'?");
  }
}

}  // namespace
}  // namespace vps::scenes
