// SPDX-License-Identifier: BSD-3-Clause
// How far a part may lean in its fits, by the formula.
#include "world/lean_in_fits.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/lathe.h"

namespace vps::scenes {
namespace {

constexpr int kFlats = 192;
constexpr double kShaft_m = 5e-3, kHole_m = 5.025e-3, kOuter_m = 10e-3;
constexpr double kClearance_m = 2 * (kHole_m - kShaft_m);

DrawnPart drawn(const std::string& name, const Mesh& mesh, const Vec3& p_WP) {
  DrawnPart part;
  part.name = name;
  part.mesh = mesh;
  part.X_WP = Pose::translation(p_WP);
  return part;
}

Mesh ring(double length_m) {
  return test::lathe({{kHole_m, 0}, {kOuter_m, 0}, {kOuter_m, length_m}, {kHole_m, length_m}}, kFlats);
}

DrawnPart shaft() {
  return drawn("shaft", test::lathe({{0, 0}, {kShaft_m, 0}, {kShaft_m, 60e-3}, {0, 60e-3}}, kFlats),
               Vec3::Zero());
}

TEST(LeanInFits, AShortRingLeansByItsClearanceOverItsLength) {
  constexpr double kLength_m = 3e-3;
  const double reach_m = std::hypot(kOuter_m, kLength_m / 2);
  const double expected_m = kClearance_m * reach_m / kLength_m;  // 169 um
  EXPECT_NEAR(leanInFits_m(drawn("ring", ring(kLength_m), {0, 0, 30e-3}), {shaft()}), expected_m,
              0.02 * expected_m);
}

TEST(LeanInFits, ALongRingIsOffByHalfItsClearance) {
  constexpr double kLength_m = 40e-3;
  const double expected_m = kClearance_m * std::hypot(kOuter_m, kLength_m / 2) / kLength_m;  // 28 um
  EXPECT_GT(expected_m, kClearance_m / 2);
  EXPECT_NEAR(leanInFits_m(drawn("ring", ring(kLength_m), {0, 0, 10e-3}), {shaft()}), expected_m,
              0.02 * expected_m);
}

// 3 mm each, 30 mm from end to end.
TEST(LeanInFits, TwoShortFitsHoldAsOneLongOne) {
  const double alone_m = leanInFits_m(shaft(), {drawn("low", ring(3e-3), {0, 0, 15e-3})});
  const double both_m = leanInFits_m(
      shaft(), {drawn("low", ring(3e-3), {0, 0, 15e-3}), drawn("high", ring(3e-3), {0, 0, 42e-3})});
  EXPECT_NEAR(both_m, kClearance_m * std::hypot(kShaft_m, 30e-3) / 30e-3, 0.02 * both_m);
  EXPECT_GT(alone_m, 10 * both_m);
}

TEST(LeanInFits, APartWithoutAFitHasNoLean) {
  EXPECT_EQ(leanInFits_m(shaft(), {}), 0);
}

}  // namespace
}  // namespace vps::scenes
