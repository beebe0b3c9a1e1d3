// SPDX-License-Identifier: BSD-3-Clause
// Whether an assembly can be put together, and whether its parts overlap as drawn, on parts with flat faces
// for which both answers are known by construction.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "scenes/drawn_part.h"
#include "support/units.h"
#include "vps_scenes/fits/check.h"

namespace vps::scenes {
namespace {

CheckResult check(const std::vector<DrawnPart>& parts) {
  return checkAssembly("places", parts, {.has_play = false, .has_places = true});
}

Pose at(double x_m, double z_m) {
  return Pose::translation({x_m, 0, z_m});
}

/// A bar along x, from z = -8 mm to 0 and 30 mm wide along y, with walls of 10 mm height on it. Walls and
/// gaps alternate between the xs, beginning and ending with a wall.
Mesh comb(const std::vector<double>& xs) {
  constexpr double kHalf_m = 15 * kMm, kLow_m = -8 * kMm, kHigh_m = 10 * kMm;
  Mesh mesh;
  const auto add = [&](double x, double y, double z) {
    mesh.vertices.emplace_back(x, y, z);
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  };
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  // Vertices for each x: front (y < 0) and back, at the bottom, at the floor of the gaps and at the top of
  // the walls.
  std::vector<std::array<std::array<std::uint32_t, 3>, 2>> at;
  for (const double x : xs) {
    auto& column = at.emplace_back();
    for (const int side : {0, 1}) {
      const double y = side == 0 ? -kHalf_m : kHalf_m;
      column[side] = {add(x, y, kLow_m), add(x, y, 0), add(x, y, kHigh_m)};
    }
  }
  const auto level = [&](std::size_t i, int low) {  // front and back between two heights
    const auto &l = at[i], &r = at[i + 1];
    quad(l[0][low], r[0][low], r[0][low + 1], l[0][low + 1]);
    quad(r[1][low], l[1][low], l[1][low + 1], r[1][low + 1]);
  };
  for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
    const auto &l = at[i], &r = at[i + 1];
    quad(l[0][0], l[1][0], r[1][0], r[0][0]);
    level(i, 0);
    if (i % 2 == 1) {
      quad(l[0][1], r[0][1], r[1][1], l[1][1]);
      continue;
    }
    level(i, 1);
    quad(l[0][2], r[0][2], r[1][2], l[1][2]);
    quad(l[1][1], l[0][1], l[0][2], l[1][2]);
    quad(r[0][1], r[1][1], r[1][2], r[0][2]);
  }
  quad(at.front()[1][0], at.front()[0][0], at.front()[0][1], at.front()[1][1]);
  quad(at.back()[0][0], at.back()[1][0], at.back()[1][1], at.back()[0][1]);
  return mesh;
}

/// A slot of a given width in the middle of a base, and a block of 10 mm that stands in it.
std::vector<DrawnPart> blockInSlot(double width_m, const Pose& X_off) {
  const double half_m = 0.5 * width_m;
  return {part("slot", comb({-half_m - 8 * kMm, -half_m, half_m, half_m + 8 * kMm})),
          part("block", makeBox({10 * kMm, 14 * kMm, 8 * kMm}), X_off * Pose::translation({0, 0, 4 * kMm}))};
}

/// Two combs that face each other, with slots at different pitches, and keys of 6 mm through both combs.
std::vector<DrawnPart> keysThroughCombs(double clearance_m, double pitch_error_m) {
  constexpr double kWidth_m = 6 * kMm, kPitch_m = 20 * kMm;
  const auto slots = [&](double pitch_m) {
    std::vector<double> xs = {-30 * kMm};
    for (const int i : {-1, 0, 1})
      for (const int side : {-1, 1}) xs.push_back(i * pitch_m + side * 0.5 * (kWidth_m + clearance_m));
    xs.push_back(30 * kMm);
    return comb(xs);
  };
  const Pose X_over(rotationFromVector(Vec3(std::numbers::pi, 0, 0)), Vec3(0, 0, 20 * kMm));
  std::vector<DrawnPart> parts = {part("base", slots(kPitch_m)),
                                  part("cover", slots(kPitch_m + pitch_error_m), X_over)};
  for (const int i : {-1, 0, 1})
    parts.push_back(part("key" + std::to_string(i + 2), makeBox({kWidth_m, 12 * kMm, 19 * kMm}),
                         Pose::translation({i * kPitch_m, 0, 10 * kMm})));
  return parts;
}

TEST(Places, WhatDoesNotOverlapAsDrawnNeedsNoOther) {
  const CheckResult found = check(blockInSlot(10 * kMm + 20 * kUm, Pose()));
  EXPECT_EQ(found.clashes(), 0U);
  EXPECT_EQ(found.places.verdict, Verdict::Fits);
  EXPECT_TRUE(found.places.moved.empty());
  EXPECT_EQ(found.verdict(), Verdict::Fits);
}

TEST(Places, ABlockDrawnIntoTheWallOfItsSlotIsFreeOnceItMovesByItsOverlap) {
  const CheckResult found = check(blockInSlot(10 * kMm + 40 * kUm, Pose::translation({30 * kUm, 0, 0})));
  EXPECT_EQ(found.clashes(), 1U);
  ASSERT_EQ(found.places.verdict, Verdict::Fits) << found.places.reason;
  ASSERT_EQ(found.places.moved.size(), 1U);
  const MovedPart& moved = found.places.moved.front();
  EXPECT_EQ(moved.name, "block");
  EXPECT_LT((moved.by_W - Vec3(-10 * kUm, 0, 0)).norm(), 0.5 * kUm) << moved.by_W.transpose();
  EXPECT_LT(moved.turn_W.norm(), 1e-5);
  EXPECT_LE(moved.most_m, moved.allowed_m);
  // A check of the parts at these places finds no clash.
  std::vector<DrawnPart> parts =
      blockInSlot(10 * kMm + 40 * kUm, moved.X_WP * Pose::translation({0, 0, -4 * kMm}));
  EXPECT_EQ(check(parts).clashes(), 0U);
}

TEST(Places, AFixedPartIsNotMoved) {
  std::vector<DrawnPart> parts = blockInSlot(10 * kMm + 40 * kUm, Pose::translation({30 * kUm, 0, 0}));
  parts[1].is_fixed = true;
  const CheckResult found = check(parts);
  ASSERT_EQ(found.places.verdict, Verdict::Fits) << found.places.reason;
  ASSERT_EQ(found.places.moved.size(), 1U);
  EXPECT_EQ(found.places.moved.front().name, "slot");
  EXPECT_GT(found.places.moved.front().by_W.x(), 9 * kUm);
  parts[0].is_fixed = true;
  EXPECT_NE(check(parts).places.verdict, Verdict::Fits);
}

/// A random number from -1 to 1 that is the same with every compiler.
double drawn(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11U) * 0x1p-52 - 1;
}

/// The overlap of a turned block with the walls of its slot: the reach of its farthest corner across the
/// slot, minus half of the slot's width.
double overlapOf(double width_m, const Pose& X_off) {
  const double turn = rotationVector(X_off.R).norm();
  return std::abs(X_off.p.x()) + 5 * kMm * std::cos(turn) + 7 * kMm * std::sin(turn) - 0.5 * width_m;
}

TEST(Places, EveryBlockThatIsDrawnIntoAFixedPartIsLookedAt) {
  for (const double second_m : {10 * kUm, 3 * kMm}) {
    std::vector<DrawnPart> parts = {
        part("a", makeBox({6 * kMm, 6 * kMm, 6 * kMm}), at(-8 * kMm, 7 * kMm - 10 * kUm)),
        part("plate", makeBox({30 * kMm, 30 * kMm, 8 * kMm}), Pose(), true),
        part("z", makeBox({6 * kMm, 6 * kMm, 6 * kMm}), at(8 * kMm, 7 * kMm - second_m))};
    const CheckResult found = check(parts);
    EXPECT_EQ(found.clashes(), 2U);
    EXPECT_EQ(found.places.verdict, second_m < kMm ? Verdict::Fits : Verdict::Blocked) << found.places.reason;
    EXPECT_EQ(found.places.moved.size(), second_m < kMm ? 2U : 1U);
  }
}

// The answer does not depend on where the loose part is drawn, inside or outside of its play.
TEST(Places, ABlockWithPlayFitsWhereverItIsDrawn) {
  std::mt19937_64 random(48);
  for (const double play_um : {2.0, 5.0, 20.0, 50.0})
    for (int i = 0; i < 20; ++i) {
      const double most_m = 0.5 * std::max(play_um, 20.0) * kUm, width_m = 10 * kMm + play_um * kUm;
      const double turn = drawn(random) * most_m / (20 * kMm), x_m = drawn(random) * most_m;
      const Pose X_off(rotationFromVector(Vec3(0, 0, turn)), Vec3(x_m, drawn(random) * kMm, 0));
      const CheckResult found = check(blockInSlot(width_m, X_off));
      EXPECT_EQ(found.places.verdict, Verdict::Fits)
          << play_um << " um, draw " << i << ": " << found.places.reason;
      // The overlap must exceed 0.5 um plus the search's 0.1 um.
      const double overlap_m = overlapOf(width_m, X_off);
      if (std::abs(overlap_m - 0.6 * kUm) < 0.15 * kUm) continue;
      EXPECT_EQ(found.clashes() > 0, overlap_m > 0.6 * kUm) << play_um << " um, draw " << i;
      EXPECT_EQ(found.places.moved.empty(), found.clashes() == 0);
    }
}

TEST(Places, ABlockThatIsTooWideFitsNowhere) {
  std::mt19937_64 random(49);
  for (const double play_um : {-5.0, -8.0, -20.0, -50.0})
    for (int i = 0; i < 6; ++i) {
      const double most_m = 10 * kUm, x_m = drawn(random) * most_m;
      const double turn = i % 2 == 0 ? 0 : drawn(random) * most_m / (20 * kMm);
      const Pose X_off(rotationFromVector(Vec3(0, 0, turn)), Vec3(x_m, drawn(random) * kMm, 0));
      const CheckResult found = check(blockInSlot(10 * kMm + play_um * kUm, X_off));
      EXPECT_GT(found.clashes(), 0U);
      // Proven over all poses within kSightTolerance_m of both parts.
      EXPECT_EQ(found.verdict(), Verdict::Blocked)
          << play_um << " um, draw " << i << ": " << found.places.reason;
    }
}

TEST(Places, KeysThroughSlotsOfTwoPitchesAreFreeWhereEachMovesByItsShare) {
  // As drawn, the outer keys overlap the cover by 10 um, and have 20 um of clearance on each side in the
  // base.
  const CheckResult found = check(keysThroughCombs(40 * kUm, 30 * kUm));
  EXPECT_EQ(found.clashes(), 2U);
  ASSERT_EQ(found.places.verdict, Verdict::Fits) << found.places.reason;
  ASSERT_EQ(found.places.moved.size(), 2U);
  for (const MovedPart& moved : found.places.moved) {
    EXPECT_TRUE(moved.name == "key1" || moved.name == "key3") << moved.name;
    EXPECT_NEAR(std::abs(moved.by_W.x()), 10 * kUm, 0.6 * kUm);
  }
}

TEST(Places, KeysThroughSlotsWhosePitchesDifferByMoreThanTheirPlayFitNowhere) {
  // An outer key needs 30 um, and its clearances give only 10 um between the middles of its two slots.
  const CheckResult found = check(keysThroughCombs(10 * kUm, 30 * kUm));
  EXPECT_EQ(found.verdict(), Verdict::NotShown) << found.places.reason;
}

TEST(Places, APinMovesWithinItsBoreAndIsBlockedByASmallerOne) {
  const auto drawn = [](double clearance_m, double off_m, int segments) {
    return check({part("hub", makeTube(10 * kMm, 5 * kMm + 0.5 * clearance_m, 12 * kMm, segments)),
                  part("pin", makeCylinder(5 * kMm, 20 * kMm, segments), at(off_m, 0))});
  };
  const CheckResult free = drawn(20 * kUm, 15 * kUm, 720);
  EXPECT_EQ(free.clashes(), 1U);
  ASSERT_EQ(free.places.verdict, Verdict::Fits) << free.places.reason;
  ASSERT_EQ(free.places.moved.size(), 1U);
  EXPECT_NEAR(free.places.moved.front().by_W.x(), -5 * kUm, 0.6 * kUm);
  // With 36 facets in a turn, facets are 19 um off the cylinder; only the fit shows the interference.
  for (const int segments : {36, 720})
    for (const double off_m : {0.0, 1 * kUm, 4 * kUm}) {
      const CheckResult tight = drawn(-10 * kUm, off_m, segments);
      EXPECT_EQ(tight.places.verdict, Verdict::Blocked)
          << segments << " facets, " << off_m << " m: " << tight.places.reason;
    }
}

TEST(Places, WhatIsDeeperThanSightLeavesItIsBlocked) {
  const auto drawn = [](double deep_m) {
    return check(
        {part("plate", makeBox({30 * kMm, 30 * kMm, 8 * kMm}), Pose(), true),
         part("block", makeBox({6 * kMm, 6 * kMm, 6 * kMm}), Pose::translation({0, 0, 7 * kMm - deep_m}))});
  };
  EXPECT_EQ(drawn(0.45 * kMm).places.verdict, Verdict::Fits);
  // The part without a fit is placed by eye, to 0.5 mm.
  EXPECT_EQ(drawn(0.55 * kMm).places.verdict, Verdict::Blocked);
  EXPECT_EQ(drawn(2 * kMm).places.verdict, Verdict::Blocked);
}

TEST(Places, PartsThatAreNowhereNearOthersShowNothing) {
  std::vector<DrawnPart> parts;
  for (int i = 0; i < 4; ++i)
    parts.push_back(part("gear" + std::to_string(i), makeCylinder(6 * kMm, 4 * kMm, 24),
                         Pose::translation({i * 20 * kMm, 0, 0})));
  const CheckResult apart = check(parts);
  EXPECT_EQ(apart.alone.size(), 4U);
  EXPECT_EQ(apart.verdict(), Verdict::NotShown);
  EXPECT_EQ(check({parts[0]}).verdict(), Verdict::Fits);
  // A plate lies below three of the gears.
  parts.push_back(
      part("plate", makeBox({60 * kMm, 20 * kMm, 4 * kMm}), Pose::translation({20 * kMm, 0, -4 * kMm})));
  const CheckResult on_plate = check(parts);
  EXPECT_EQ(on_plate.alone, std::vector<std::string>{"gear3"});
  EXPECT_EQ(on_plate.verdict(), Verdict::NotShown);
  parts.erase(parts.begin() + 3);
  EXPECT_EQ(check(parts).verdict(), Verdict::Fits);
}

}  // namespace
}  // namespace vps::scenes
