// SPDX-License-Identifier: BSD-3-Clause
// The depth and volume of a check are properties of the solids: they do not depend on how faces are divided.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "support/lathe.h"
#include "support/random_draw.h"
#include "vps_scenes/fits/check.h"

namespace vps::scenes {
namespace {

constexpr double kPi = std::numbers::pi;

/// Divides each triangle into four.
Mesh refined(const Mesh& mesh) {
  Mesh fine;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto first = static_cast<std::uint32_t>(fine.vertices.size());
    fine.vertices.insert(fine.vertices.end(), {a, b, c});
    fine.triangles.push_back({first, first + 1, first + 2});
  };
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    add(a, ab, ca);
    add(ab, b, bc);
    add(ca, bc, c);
    add(ab, bc, ca);
  }
  return fine;
}

Mesh cutBox(const Vec3& size_m, int times) {
  Mesh mesh = makeBox(size_m);
  for (int i = 0; i < times; ++i) mesh = refined(mesh);
  return mesh;
}

/// A ball in circles of latitude.
Mesh turnedBall(double radius_m, int segments) {
  std::vector<std::array<double, 2>> profile;
  const int rings = segments / 2;
  for (int i = 0; i <= rings; ++i) {
    const double angle_rad = -kPi / 2 + kPi * i / rings;
    const bool is_pole = i == 0 || i == rings;
    profile.push_back({is_pole ? 0 : radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad)});
  }
  return test::lathe(profile, segments);
}

/// Ten divisions of a ball and of a box.
Mesh ball(double radius_m, int division) {
  constexpr std::array kSegments = {40, 48, 56, 64, 72, 80, 96};
  return division < 3 ? makeSphere(radius_m, division + 3) : turnedBall(radius_m, kSegments.at(division - 3));
}
Mesh box(const Vec3& size_m, int division) {
  return cutBox(size_m, division % 4);
}

/// Measures two parts in a random frame; the second part is at a given place in the frame.
CheckedPair measured(const Mesh& a, const Mesh& b, const Vec3& p_AB, int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::normal_distribution<double> draw;
  const Pose X_WA(test::drawnRotation(draw, random).toRotationMatrix(),
                  0.01 * test::drawnVector(draw, random));
  const CheckResult result =
      checkAssembly("test", {{"a", a, X_WA, {}, false}, {"b", b, X_WA * Pose::translation(p_AB), {}, false}},
                    {.has_fits = false, .has_play = false});
  return result.pairs.at(0);
}

/// Expects that the depth is right within its error, and that the error is at most twice the balls' chord
/// errors plus a ten-thousandth of the depth.
void expectDepth(const CheckedPair& pair, double depth_m, double chord_m, const std::string& what) {
  EXPECT_NEAR(pair.interference_depth_m, depth_m, pair.error_m) << what;
  EXPECT_LE(pair.error_m, 4 * chord_m + std::max(0.11e-6, 1.1e-4 * depth_m)) << what;
  EXPECT_EQ(pair.state, PairState::Clash) << what;
}

/// Chord error of the coarsest ball, with 40 segments, or of an icosahedron that is divided three times and
/// has edges of 7.9 degrees. A facet is inside the ball by the depth of its circumscribed circle, up to 1.33
/// times an edge's chord error.
double chordOf(double radius_m) {
  return 2 * radius_m * (1 - std::cos(kPi / 40));
}

TEST(OverlapDepth, APlateInABallIsAsDeepAsItsFaceIsBelowTheBall) {
  const double r = 20e-3, t = 2e-3;
  for (int division = 0; division < 10; ++division)
    for (const double above_m : {0.0, 0.6e-3, 5e-3}) {
      // The deepest point is the middle of the plate's face that is nearer to the centre.
      const double depth_m = r - std::abs(above_m - 0.5 * t);
      expectDepth(
          measured(ball(r, 9 - division), box({30e-3, 30e-3, t}, division), {0, 0, above_m}, division),
          depth_m, chordOf(r), std::to_string(division) + " at " + std::to_string(above_m));
    }
}

TEST(OverlapDepth, APlateThroughACubeIsAsDeepAsItsFaceIsBelowTheCube) {
  for (int division = 0; division < 10; ++division)
    expectDepth(measured(box({40e-3, 40e-3, 40e-3}, division / 4), box({60e-3, 60e-3, 2e-3}, division),
                         {1e-3, -2e-3, 3e-3}, division),
                18e-3, 0, std::to_string(division));  // 20 mm less 2 mm
}

TEST(OverlapDepth, ACubeInACubeIsAsDeepAsItsFacesAreOrAsThick) {
  for (int division = 0; division < 10; ++division)
    for (const double c : {2e-3, 10e-3, 16e-3, 30e-3}) {
      const double depth_m = std::max(0.5 * (40e-3 - c), c);
      expectDepth(measured(box({40e-3, 40e-3, 40e-3}, division / 4), box({c, c, c}, division), Vec3::Zero(),
                           division),
                  depth_m, 0, std::to_string(division) + ", " + std::to_string(c));
    }
}

TEST(OverlapDepth, ABallInABallIsAsDeepAsTheCirclesSay) {
  const double r = 5e-3, R = 12e-3;
  for (int division = 0; division < 10; ++division)
    for (const double d : {9e-3, 14e-3, 16e-3}) {
      if (d < 14e-3 && division % 3 != 0) continue;  // many facets are equally far, so the search takes long
      const double surface_m = std::max(R - std::abs(r - d), r - std::abs(R - d));
      const double shared_m = std::min(2 * r, R + r - d);
      expectDepth(measured(ball(R, division), ball(r, 9 - division), Vec3(0.6, 0, 0.8) * d, division),
                  std::max(surface_m, shared_m), chordOf(R) + chordOf(r),
                  std::to_string(division) + " at " + std::to_string(d));
    }
}

// The greatest ball in both bars lies between their sides; the depth along their edges is smaller.
TEST(OverlapDepth, BarsThatCrossAreAsDeepAsWhatTheyShareIsThick) {
  for (int division = 0; division < 10; ++division)
    expectDepth(measured(box({100e-3, 10e-3, 10e-3}, division), box({6e-3, 100e-3, 6e-3}, division / 3),
                         {3e-3, 1e-3, 0.5e-3}, division),
                6e-3, 0, std::to_string(division));
}

TEST(OverlapDepth, APartDrawnTwiceIsAsDeepAsItIsThick) {
  for (int division = 0; division < 10; ++division)
    expectDepth(measured(box({100e-3, 80e-3, 2e-3}, division), box({100e-3, 80e-3, 2e-3}, division / 3),
                         Vec3::Zero(), division),
                2e-3, 0, std::to_string(division));
}

// The edges of a hollow point into the part. The greatest ball touches one of these edges and the floor.
TEST(OverlapDepth, TheBallBetweenAConesTipAndAFaceIsFound) {
  const double tip_m = 4e-3;
  for (const int segments : {8, 13, 24, 40}) {
    // A block with a conical pit of 118 degrees; its tip is tip_m above the floor.
    const double depth_m = 5e-3, rim_m = depth_m * std::tan(59 * kPi / 180);
    const Mesh block = test::lathe(
        {{0, 0}, {20e-3, 0}, {20e-3, tip_m + depth_m}, {rim_m, tip_m + depth_m}, {0, tip_m}}, segments);
    // The other part is a tall box that is wider than the ball and narrower than the pit.
    const CheckedPair pair = measured(block, makeBox({5e-3, 5e-3, 40e-3}), Vec3::Zero(), segments);
    // The box's surface inside the block is no deeper than half of the block's height there, 4 + 5 mm * 2.5 /
    // 8.32.
    EXPECT_GE(pair.interference_depth_m, tip_m - pair.error_m) << segments;
    EXPECT_LE(pair.interference_depth_m, 5e-3 + pair.error_m) << segments;
  }
}

TEST(OverlapVolume, IsKnownWithinAPartOfItWhereverFlatFacesBoundIt) {
  const double r = 20e-3;
  for (int division = 0; division < 10; division += 3) {
    for (const double t : {0.1e-3, 2e-3}) {
      const CheckedPair pair =
          measured(ball(r, 9 - division), box({60e-3, 60e-3, t}, division), Vec3::Zero(), division);
      const double volume_m3 = kPi * (r * r * t - t * t * t / 12);
      EXPECT_NEAR(pair.interference_volume_m3, volume_m3, pair.volume_error_m3) << division << ", " << t;
      EXPECT_LT(pair.volume_error_m3, 0.1 * volume_m3) << division << ", " << t;
    }
    // A disc is pressed into a plate by 5 um. The disc's side has a chord error, its face has none.
    const int segments = 32 + 16 * division;
    const Mesh disc = test::lathe({{0, -5e-6}, {r, -5e-6}, {r, 10e-3}, {0, 10e-3}}, segments);
    const CheckedPair pair = measured(test::lathe({{0, -20e-3}, {50e-3, -20e-3}, {50e-3, 0}, {0, 0}}, 4),
                                      disc, Vec3::Zero(), division);
    const double volume_m3 = kPi * r * r * 5e-6;
    EXPECT_NEAR(pair.interference_volume_m3, volume_m3, pair.volume_error_m3) << segments;
    EXPECT_LT(pair.volume_error_m3, 0.03 * volume_m3) << segments;
  }
}

}  // namespace
}  // namespace vps::scenes
