// SPDX-License-Identifier: BSD-3-Clause
// Play and directions of removal of parts for which both are known by a formula.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>
#include <random>

#include "motion/motion_search.h"
#include "scenes/assemblies_to_plan.h"
#include "scenes/drawn_part.h"
#include "support/lathe.h"
#include "support/random_draw.h"
#include "vps_scenes/fits/check.h"

namespace vps::scenes {
namespace {

constexpr double kMetre = 1e-6, kRadian = 1e-4;  // guaranteed accuracy of the play

CheckedPart playOf(const std::string& name, const std::vector<DrawnPart>& parts) {
  for (const CheckedPart& found : checkAssembly("test", parts).parts)
    if (found.name == name) return found;
  return {};
}
void expectBoth(const std::array<double, 6>& play, int axis, double value, double within) {
  for (const int i : {2 * axis, 2 * axis + 1})
    EXPECT_NEAR(play[static_cast<std::size_t>(i)], value, within) << i;
}
void expectFree(const std::array<double, 6>& play, int axis) {
  for (const int i : {2 * axis, 2 * axis + 1})
    EXPECT_TRUE(std::isinf(play[static_cast<std::size_t>(i)])) << i;
}
/// The angle at which r cos + h sin equals `reach`: a corner at (r, h) reaches a wall.
double tilt(double r, double h, double reach) {
  return std::acos(reach / std::hypot(r, h)) * -1 + std::atan2(h, r);
}
bool has(const std::vector<Vec3>& ways, const Vec3& d) {
  return std::any_of(ways.begin(), ways.end(), [&](const Vec3& way) { return (way - d).norm() < 1e-6; });
}

// A round peg in a bore of its own size. The corners of peg and bore are at different angles, so that their
// facets cross.
TEST(CheckPlay, IsNotCertainWhereRoundFacesOfOneSizeTouch) {
  const CheckedPart peg =
      playOf("peg", {part("bore", makeTube(0.01, 4e-3, 0.02, 100)),
                     part("peg", transformed(makeCylinder(4e-3, 0.02, 100),
                                             Pose(rotationFromVector({0, 0, 0.03}), {0, 0, 0})))});
  ASSERT_TRUE(peg.play);
  EXPECT_FALSE(peg.is_play_certain);
}

// The facets of cone and cup are equal and aligned. The cone's facets are 7.4 um inside the cup's, so that
// its edges pass the cup's facets at 3 um at any rotation.
TEST(CheckPlay, AConeInACupTurnsFreely) {
  constexpr double kLow_m = 6e-3, kHigh_m = 10e-3, kHeight_m = 10e-3, kRaised_m = 20e-6;
  const std::vector<DrawnPart> parts = {
      part("cup", test::lathe({{kLow_m, 0}, {14e-3, 0}, {14e-3, kHeight_m}, {kHigh_m, kHeight_m}}, 96)),
      part("cone", test::lathe({{0, 0}, {kLow_m, 0}, {kHigh_m, kHeight_m}, {0, kHeight_m}}, 96),
           Pose::translation(Vec3(0, 0, kRaised_m)))};
  for (const char* name : {"cup", "cone"}) {
    const CheckedPart found = playOf(name, parts);
    ASSERT_TRUE(found.play) << name;
    expectFree(found.play->rad, 2);
    expectBoth(found.play->m, 0, kRaised_m * (kHigh_m - kLow_m) / kHeight_m, 0.1e-6);
  }
}

// Two plates with many holes lie on each other: hundreds of edges of holes cross while one slides.
TEST(CheckPlay, APlateWithHolesSlidesOnAnother) {
  const Pose X_W(rotationFromVector({0.5, 0.2, -0.7}), {0.01, 0.02, 0.03});
  const Mesh plate = perforatedPlate(5, 5e-3, 1.5e-3, 2e-3);
  const Vec3 shift(1.3e-3, 0.9e-3, 2e-3);
  const auto upper = [&](const std::vector<DrawnPart>& more) {
    std::vector<DrawnPart> parts = {part("lower", plate, X_W),
                                    part("upper", plate, X_W * Pose::translation(shift))};
    parts.insert(parts.end(), more.begin(), more.end());
    return playOf("upper", parts);
  };
  const CheckedPart free = upper({});
  for (const int axis : {0, 1})
    for (const double sign : {1.0, -1.0}) EXPECT_TRUE(has(free.ways_out_W, sign * X_W.R.col(axis))) << axis;
  EXPECT_TRUE(has(free.ways_out_W, X_W.R.col(2)));
  EXPECT_FALSE(has(free.ways_out_W, -X_W.R.col(2)));
  for (const Vec3& way : free.ways_out_W) EXPECT_GT(way.dot(X_W.R.col(2)), -1e-9);

  // A square pin of 2 mm in the middle of a hole of the upper plate, whose facets are along x and y.
  const Vec3 hole = Vec3(2.5e-3, 2.5e-3, 0) + shift + Vec3(0, 0, 1e-3);
  const CheckedPart pinned =
      upper({part("pin", makeBox(Vec3(1e-3, 1e-3, 2e-3)), X_W * Pose::translation(hole))});
  // The hole is 2 mm high and leaves the pin less than 1 mm to each side.
  EXPECT_TRUE(has(pinned.ways_out_W, X_W.R.col(2)));
  for (const Vec3& way : pinned.ways_out_W) EXPECT_GT(way.dot(X_W.R.col(2)), std::cos(std::atan(0.5)));
  // The pin's corners at 0.5 mm reach the hole's facet at the angle pi / 32 from x, which is 2 um nearer than
  // its circle.
  ASSERT_TRUE(pinned.play);
  const double half = 0.5e-3, chord_m = 1.5e-3 * (1 - std::cos(std::numbers::pi / 32));
  const double reach_m = std::sqrt(1.5e-3 * 1.5e-3 - half * half) - half;
  for (const std::size_t i : {0U, 1U, 2U, 3U}) {
    EXPECT_LT(pinned.play->m[i], reach_m + kMetre);
    EXPECT_GT(pinned.play->m[i], reach_m - 2 * chord_m - kMetre);
  }
}

// The limit counts work, so that it is the same on every machine.
TEST(CheckPlay, AMotionEndsAsStoppedWhereItsWorkIsSpent) {
  const std::vector<DrawnPart> parts = {part("bore", makeTube(0.01, 4.1e-3, 0.02, 100)),
                                        part("peg", makeCylinder(4e-3, 0.02, 100))};
  const std::vector<PlacedSurface> placed = placedSurfaces(parts, {});
  const auto bore = std::make_shared<const StandingParts>(std::vector<const PlacedSurface*>{&placed[0]});
  const MotionSearch search(placed[1], bore, {0});
  const Motion up{Vec3::UnitZ(), Vec3::Zero(), false};
  SearchWork enough{1'000'000}, little{10};
  EXPECT_FALSE(search.reach(up, 0.1, &enough).is_stopped);
  EXPECT_FALSE(enough.isSpent());
  EXPECT_GT(enough.done, little.most);
  EXPECT_TRUE(search.reach(up, 0.1, &little).is_stopped);
  EXPECT_TRUE(little.isSpent());
  EXPECT_EQ(little.done, little.most);
}

// A tree finds the parts near a motion. The expected result is the first of the parts that stop the motion
// individually.
TEST(CheckPlay, AmongManyPartsAMotionIsStoppedByTheFirstOfThem) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-0.05, 0.05), size(2e-3, 20e-3);
  std::normal_distribution<double> normal;
  std::vector<DrawnPart> parts;
  for (int i = 0; i < 60; ++i) {
    parts.push_back(part("box " + std::to_string(i), makeBox(test::drawnVector(size, random))));
    const Quat turned = test::drawnRotation(normal, random);
    parts.back().X_WP = Pose{turned, Vec3{place(random), place(random), 4e-3 * i}};  // some overlap
  }
  const std::vector<PlacedSurface> placed = placedSurfaces(parts, {});
  std::vector<const PlacedSurface*> pointers;
  for (const PlacedSurface& one : placed) pointers.push_back(&one);
  const auto all = std::make_shared<const StandingParts>(pointers);
  std::vector<double> crossing_m(placed.size());  // one element is much greater than the others
  crossing_m[5] = 0.5e-3;
  int stopped = 0;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    std::vector<double> of_this = crossing_m;
    of_this[i] = 0;
    const MotionSearch among_all(placed[i], all, of_this, CrossingDepth::UpToMost);
    for (const bool is_turn : {false, true}) {
      const Motion motion{test::drawnVector(normal, random).normalized(), placed[i].box_W.center(), is_turn};
      const double most = is_turn ? 2 : 0.5;
      double first = most;
      for (const PlacedSurface* held : pointers) {
        if (held == &placed[i]) continue;
        const auto alone = std::make_shared<const StandingParts>(std::vector{held});
        const std::vector<double> of_pair = {held == &placed[5] ? crossing_m[5] : 0};
        first = std::min(
            first, MotionSearch(placed[i], alone, of_pair, CrossingDepth::UpToMost).reach(motion, most).s);
      }
      const Reach reach = among_all.reach(motion, most);
      // Each motion ends within a tenth of the rest depth of the point where facets meet. The motion is then
      // shortened by the rest depth divided by the closing speed, which is at least a tenth of the speed of
      // the fastest corner, here over 1 mm from the axis.
      EXPECT_NEAR(reach.s, first, 10 * MotionSearch::kRest_m / (is_turn ? 1e-3 : 1)) << i << is_turn;
      EXPECT_EQ(reach.is_stopped, first < most);
      stopped += reach.is_stopped && reach.s > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(stopped, 15);
}

TEST(CheckPlay, NearPairsAreThoseWhoseBoxesAreNear) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> place(-0.05, 0.05);
  std::vector<DrawnPart> parts;
  for (int i = 0; i < 80; ++i) {
    parts.push_back(part("box " + std::to_string(i), makeBox({4e-3, 6e-3, 8e-3})));
    parts.back().X_WP = Pose::translation(test::drawnVector(place, random));
  }
  const std::vector<PlacedSurface> placed = placedSurfaces(parts, {});
  for (const double near_m : {0.0, 1e-3, 10e-3}) {
    std::vector<std::pair<std::size_t, std::size_t>> expected;
    for (std::size_t a = 0; a < placed.size(); ++a)
      for (std::size_t b = a + 1; b < placed.size(); ++b)
        if (distance2(placed[a].box_W, placed[b].box_W) <= near_m * near_m) expected.emplace_back(a, b);
    EXPECT_EQ(nearPairs(placed, near_m), expected);
    EXPECT_GT(expected.size(), 3u);
  }
}

// A peg of 8 mm that is as long as its bore. It can move by half the clearance across, and tilt until both
// ends touch.
TEST(CheckPlay, APegInAThroughBore) {
  const double r = 4e-3, length_m = 20e-3;
  for (const double clearance_m : {10e-6, 50e-6, 200e-6}) {
    const double bore_m = r + clearance_m / 2;
    const CheckedPart peg = playOf("peg", {part("bore", makeTube(0.01, bore_m, length_m, 720)),
                                           part("peg", makeCylinder(r, length_m, 720))});
    ASSERT_TRUE(peg.play);
    expectBoth(peg.play->m, 0, clearance_m / 2, kMetre);
    expectBoth(peg.play->m, 1, clearance_m / 2, kMetre);
    expectFree(peg.play->m, 2);
    expectBoth(peg.play->rad, 0, tilt(r, length_m / 2, bore_m), kRadian);
    expectBoth(peg.play->rad, 1, tilt(r, length_m / 2, bore_m), kRadian);
    expectFree(peg.play->rad, 2);
    EXPECT_EQ(peg.ways_out_W.size(), 2U);
    EXPECT_TRUE(has(peg.ways_out_W, Vec3::UnitZ()));
    EXPECT_TRUE(has(peg.ways_out_W, -Vec3::UnitZ()));
    EXPECT_LT(peg.play_error_m, kMetre);
    EXPECT_TRUE(peg.is_play_certain);
  }
}

/// A shaft with a taper, in a bore with the same taper: the radius of both grows by a hundredth of the
/// height.
Mesh taper(double radius_m, double outer_m, int segments) {
  constexpr double kHeight_m = 30e-3, kGrows_m = 0.3e-3;
  if (outer_m == 0)
    return test::lathe({{0, 0}, {radius_m, 0}, {radius_m + kGrows_m, kHeight_m}, {0, kHeight_m}}, segments);
  return test::lathe({{radius_m, 0}, {outer_m, 0}, {outer_m, kHeight_m}, {radius_m + kGrows_m, kHeight_m}},
                     segments);
}

// A pin whose radius is 10 um too small sinks by a hundred times as much; the error is multiplied by the same
// factor.
TEST(CheckPlay, ATaperSinksByItsLackOverItsSlopeWithinTheErrorThatIsSaid) {
  for (const auto& [bore_segments, pin_segments] : {std::pair{64, 64}, {64, 61}, {128, 100}, {200, 180}})
    for (const double lack_m : {5e-6, 10e-6}) {
      const CheckedPart pin = playOf("pin", {part("block", taper(4e-3, 20e-3, bore_segments)),
                                             part("pin", taper(4e-3 - lack_m, 0, pin_segments))});
      ASSERT_TRUE(pin.play);
      EXPECT_NEAR(pin.play->m[5], 100 * lack_m, pin.play->error_m[5])
          << bore_segments << ", " << pin_segments;
      // Twice the chord errors of bore and pin, because these errors are estimates, plus the rest depth,
      // divided by the slope.
      const double chords_m = 4.3e-3 * std::pow(std::numbers::pi, 2) / 2 *
                              (1 / std::pow(bore_segments, 2) + 1 / std::pow(pin_segments, 2));
      EXPECT_LT(pin.play->error_m[5], 102 * (2 * chords_m + 0.3e-6)) << bore_segments << ", " << pin_segments;
      EXPECT_TRUE(std::isinf(pin.play->m[4]));
      EXPECT_EQ(pin.play->error_m[4], 0);
    }
}

// The same scene with another number of facets, at another pose.
TEST(CheckPlay, MovesWithTheAssembly) {
  const Pose X(rotationFromVector(Vec3(0.6, -0.5, 0.8)), Vec3(0.1, -0.05, 0.2));
  const CheckedPart peg = playOf("peg", {part("bore", makeTube(0.01, 4.025e-3, 20e-3, 900), X),
                                         part("peg", makeCylinder(4e-3, 20e-3, 640), X)});
  ASSERT_TRUE(peg.play);
  expectBoth(peg.play->m, 0, 25e-6, kMetre);
  expectBoth(peg.play->m, 1, 25e-6, kMetre);
  expectFree(peg.play->m, 2);
  expectBoth(peg.play->rad, 0, tilt(4e-3, 10e-3, 4.025e-3), kRadian);
  expectFree(peg.play->rad, 2);
  EXPECT_TRUE(has(peg.ways_out_W, X.R * Vec3::UnitZ()));
}

TEST(CheckPlay, APegInABlindBoreStandsOnItsFloor) {
  const Mesh bore =
      test::lathe({{0, -5e-3}, {10e-3, -5e-3}, {10e-3, 20e-3}, {4.02e-3, 20e-3}, {4.02e-3, 0}, {0, 0}}, 720);
  const CheckedPart peg = playOf("peg", {part("bore", bore), part("peg", makeCylinder(4e-3, 20e-3, 720),
                                                                  Pose::translation(Vec3(0, 0, 10e-3)))});
  ASSERT_TRUE(peg.play);
  expectBoth(peg.play->m, 0, 20e-6, kMetre);
  EXPECT_TRUE(std::isinf(peg.play->m[4]));
  EXPECT_NEAR(peg.play->m[5], 0, kMetre);
  EXPECT_NEAR(peg.play->rad[0], 0, kRadian);  // its rim would enter the floor
  expectFree(peg.play->rad, 2);
  ASSERT_EQ(peg.ways_out_W.size(), 1U);
  EXPECT_TRUE(has(peg.ways_out_W, Vec3::UnitZ()));
}

// A key of 5 x 20 mm between walls of its own length, 3 um above a floor.
TEST(CheckPlay, AKeyInASlot) {
  const double b = 5e-3, l = 20e-3, h = 6e-3, c = 40e-6, below_m = 3e-6;
  Mesh slot = transformed(makeBox(Vec3(0.03, l, 0.01)), Pose::translation(Vec3(0, 0, -0.005 - below_m)));
  for (const double side : {-1.0, 1.0})
    append(slot,
           transformed(makeBox(Vec3(0.01, l, h + 0.001)),
                       Pose::translation(Vec3(side * (b + c + 0.01) / 2, 0, (h + 0.001) / 2 - 0.0005))));
  const CheckedPart key = playOf(
      "key", {part("slot", slot), part("key", makeBox(Vec3(b, l, h)), Pose::translation(Vec3(0, 0, h / 2)))});
  ASSERT_TRUE(key.play);
  expectBoth(key.play->m, 0, c / 2, kMetre);
  expectFree(key.play->m, 1);
  EXPECT_TRUE(std::isinf(key.play->m[4]));
  EXPECT_NEAR(key.play->m[5], below_m, kMetre);
  expectBoth(key.play->rad, 2, tilt(b / 2, l / 2, (b + c) / 2), kRadian);
  expectBoth(key.play->rad, 0, tilt(h / 2, l / 2, h / 2 + below_m), kRadian);
  EXPECT_EQ(key.ways_out_W.size(),
            5U);  // both directions along the slot, up, and two of the directions in between
  for (const Vec3& d : {Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)})
    EXPECT_TRUE(has(key.ways_out_W, d)) << d;
  for (const Vec3& d : key.ways_out_W) EXPECT_NEAR(d.x(), 0, 1e-9);
}

// A disc between two shoulders that cover it, around a shaft with more clearance than the disc needs to tilt.
TEST(CheckPlay, ADiscBetweenShoulders) {
  const double r = 10e-3, t = 4e-3, c = 30e-6;
  const Mesh disc = makeTube(r, 5e-3, t, 720);
  const double s = (t + c) / 2;
  const Mesh spool = test::lathe({{0, -s - 5e-3},
                                  {15e-3, -s - 5e-3},
                                  {15e-3, -s},
                                  {4.8e-3, -s},
                                  {4.8e-3, s},
                                  {15e-3, s},
                                  {15e-3, s + 5e-3},
                                  {0, s + 5e-3}},
                                 720);
  const CheckedPart found = playOf("disc", {part("disc", disc), part("spool", spool)});
  ASSERT_TRUE(found.play);
  expectBoth(found.play->m, 2, c / 2, kMetre);
  expectBoth(found.play->m, 0, 0.2e-3, kMetre);
  expectBoth(found.play->rad, 0, tilt(t / 2, r, s), kRadian);
  expectFree(found.play->rad, 2);
  EXPECT_TRUE(found.ways_out_W.empty());
}

TEST(CheckPlay, ABlockOnAPlateLeavesIntoTheHalfSpaceAboveOnly) {
  const CheckedPart block =
      playOf("block",
             {part("plate", makeBox(Vec3(0.1, 0.1, 0.01))),
              part("block", makeBox(Vec3(0.02, 0.02, 0.02)), Pose::translation(Vec3(0.003, 0.001, 0.015)))});
  ASSERT_TRUE(block.play);
  EXPECT_NEAR(block.play->m[5], 0, kMetre);
  for (const std::size_t i : {0U, 1U, 2U, 3U, 4U}) EXPECT_TRUE(std::isinf(block.play->m[i])) << i;
  EXPECT_GT(block.ways_out_W.size(), 20U);
  for (const Vec3& d : block.ways_out_W) EXPECT_GE(d.z(), -1e-9);
}

// Two blocks stacked flush: their side walls are coplanar, and only the faces between them stop the upper
// block.
TEST(CheckPlay, EqualBlocksOneOnAnother) {
  const Mesh block = makeBox(Vec3(0.02, 0.02, 0.02));
  const CheckedPart upper =
      playOf("upper", {part("lower", block), part("upper", block, Pose::translation(Vec3(0, 0, 0.02)))});
  ASSERT_TRUE(upper.play);
  EXPECT_NEAR(upper.play->m[5], 0, kMetre);
  EXPECT_TRUE(std::isinf(upper.play->m[4]));
  EXPECT_TRUE(std::isinf(upper.play->m[0]));
  expectFree(upper.play->rad, 2);
}

TEST(CheckPlay, APartInAClosedBoxHasNoWayOut) {
  Mesh shell = makeBox(Vec3(0.04, 0.04, 0.04)), room = makeBox(Vec3(0.02, 0.02, 0.02));
  for (auto& t : room.triangles) std::swap(t[0], t[1]);
  append(shell, room);
  const CheckedPart cube = playOf("cube", {part("shell", shell), part("cube", makeBox(Vec3(0.01, 0.01, 0.01)),
                                                                      Pose::translation(Vec3(0.001, 0, 0)))});
  ASSERT_TRUE(cube.play);
  EXPECT_NEAR(cube.play->m[0], 0.004, kMetre);
  EXPECT_NEAR(cube.play->m[1], 0.006, kMetre);
  expectBoth(cube.play->m, 1, 0.005, kMetre);
  EXPECT_TRUE(cube.ways_out_W.empty());
  expectFree(cube.play->rad, 0);  // its diagonal of 7.1 mm turns in 9 mm
}

TEST(CheckPlay, APartThatClashesHasNone) {
  const CheckedPart block = playOf(
      "block", {part("plate", makeBox(Vec3(0.1, 0.1, 0.01))),
                part("block", makeBox(Vec3(0.02, 0.02, 0.02)), Pose::translation(Vec3(0, 0, 0.0149)))});
  EXPECT_FALSE(block.play);
}

TEST(CheckPlay, AnyNumberOfThreadsGivesTheSameBits) {
  const std::vector<DrawnPart> parts = {
      part("bore", makeTube(0.01, 4.02e-3, 0.02, 90)), part("peg", makeCylinder(4e-3, 0.02, 60)),
      part("cap", makeBox(Vec3(0.01, 0.01, 0.01)), Pose::translation(Vec3(0, 0, 0.0151)))};
  const auto run = [&](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return checkAssembly("test", parts);
  };
  const CheckResult one = run(1), four = run(4);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    ASSERT_TRUE(one.parts[i].play && four.parts[i].play);
    EXPECT_EQ(one.parts[i].play->m, four.parts[i].play->m);
    EXPECT_EQ(one.parts[i].play->rad, four.parts[i].play->rad);
    EXPECT_EQ(one.parts[i].ways_out_W, four.parts[i].ways_out_W);
  }
}

TEST(CheckPlay, WhatIsAskedOfOnePartIsWhatTheWholeCheckSaysOfIt) {
  const std::vector<DrawnPart> parts = {
      part("bore", makeTube(0.01, 4.02e-3, 0.02, 90)), part("peg", makeCylinder(4e-3, 0.02, 60)),
      part("cap", makeBox(Vec3(0.01, 0.01, 0.01)), Pose::translation(Vec3(0, 0, 0.0151)))};
  const CheckResult whole = checkAssembly("test", parts);
  CheckSettings settings;
  settings.only_parts = {"peg"};
  const CheckResult asked = checkAssembly("test", parts, settings);
  ASSERT_EQ(whole.pairs.size(), 3U);
  ASSERT_EQ(asked.pairs.size(), 2U);  // without the pair of bore and cap
  for (const CheckedPair& pair : asked.pairs) {
    const auto same = std::ranges::find_if(
        whole.pairs, [&](const CheckedPair& p) { return p.a == pair.a && p.b == pair.b; });
    ASSERT_NE(same, whole.pairs.end());
    EXPECT_TRUE(pair.a == "peg" || pair.b == "peg");
    EXPECT_EQ(pair.clearance_m, same->clearance_m);
  }
  EXPECT_EQ(asked.fits.size(), whole.fits.size());
  ASSERT_TRUE(asked.parts[1].play);
  EXPECT_EQ(asked.parts[1].play->m, whole.parts[1].play->m);
  EXPECT_EQ(asked.parts[1].ways_out_W, whole.parts[1].ways_out_W);
  EXPECT_FALSE(asked.parts[0].play || asked.parts[2].play);
}

}  // namespace
}  // namespace vps::scenes
