// SPDX-License-Identifier: BSD-3-Clause
#include "vps/spin_clearance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/feature_body.h"
#include "support/lathe.h"
#include "support/random_draw.h"

namespace vps {
namespace {

constexpr double kTurn_rad = 0.3;
constexpr double kLeastGap_m = 1e-6;

using Body = test::FeatureBody;

/// A turned ring with facets of 7.5 degrees; its bore is narrower than the radius of its vertices.
Mesh ring(double bore_m) {
  return test::lathe({{bore_m, -5e-3}, {9e-3, -5e-3}, {9e-3, 5e-3}, {bore_m, 5e-3}}, 48);
}
Mesh shaft(double radius_m, int sides) {
  return test::lathe({{0, -12e-3}, {radius_m, -12e-3}, {radius_m, 12e-3}, {0, 12e-3}}, sides);
}
double narrowest_m(double bore_m) {
  return bore_m * std::cos(std::numbers::pi / 48);
}

Pose turnedAbout(const Pose& at, double angle_rad) {
  return at * Pose(rotationFromVector(Vec3(0, 0, angle_rad)), Vec3::Zero());
}

// The answer after the number of calls that a search may wait for.
bool staysApart(SpinClearance& spin, const Body& a, const Body& b, const Pose& start, const Pose& end,
                double least_m = kLeastGap_m) {
  bool is_apart = false;
  for (int i = 0; i < 8 && !is_apart; ++i)
    is_apart = spin.staysApart(a.features, b.features, start, end, least_m);
  return is_apart;
}

TEST(SpinClearance, IsTheRoomAroundAShaftInItsBore) {
  const Body outer(ring(5.025e-3));
  // An axis placed as in CAD files, so that it is aligned with no coordinate axis.
  const Pose X_01(rotationFromVector(Vec3(0.4, -1.1, 0.7)), Vec3(3e-3, 1e-3, -2e-3));
  Mesh moved = ring(5.025e-3);
  for (Vec3& v : moved.vertices) v = X_01 * v;
  const Body placed(moved);
  for (const int sides : {6, 48, 200}) {
    const Body inner(shaft(5e-3, sides));
    const double room_m = narrowest_m(5.025e-3) - 5e-3;
    // The search finds a clearance to within a sixteenth.
    SpinClearance spin;
    EXPECT_TRUE(staysApart(spin, placed, inner, X_01, turnedAbout(X_01, kTurn_rad), 0.9 * room_m)) << sides;
    EXPECT_FALSE(staysApart(spin, placed, inner, X_01, turnedAbout(X_01, kTurn_rad), 1.01 * room_m)) << sides;
    SpinClearance swapped;
    EXPECT_TRUE(staysApart(swapped, inner, placed, X_01.inverse(), turnedAbout(X_01, kTurn_rad).inverse(),
                           0.9 * room_m))
        << sides;
  }
}

TEST(SpinClearance, IsNoneWhereCornersPassThroughTheOtherPart) {
  // A square bar in a square hole has room beside its faces, but none for its corners.
  const Body hole(test::lathe({{6e-3, -5e-3}, {12e-3, -5e-3}, {12e-3, 5e-3}, {6e-3, 5e-3}}, 4));
  SpinClearance spin;
  EXPECT_FALSE(staysApart(spin, hole, Body(shaft(5.5e-3, 4)), Pose(), turnedAbout(Pose(), kTurn_rad), 0));
  // Across its corners this bar is narrower than the hole across its faces.
  SpinClearance thinner;
  EXPECT_TRUE(staysApart(thinner, hole, Body(shaft(4.2e-3, 4)), Pose(), turnedAbout(Pose(), kTurn_rad)));
}

TEST(SpinClearance, KnowsAFacetThatSurroundsTheAxis) {
  // The end of a shaft above a plate: the plate's facets have no vertex near the axis.
  const Body plate(makeBox({40e-3, 40e-3, 2e-3}));
  const Body inner(shaft(5e-3, 48));
  const Pose above(Mat3::Identity(), Vec3(0, 0, 13e-3 + 20e-6)),
      in(Mat3::Identity(), Vec3(0, 0, 13e-3 - 1e-6));
  SpinClearance spin, touching;
  EXPECT_TRUE(staysApart(spin, plate, inner, above, turnedAbout(above, kTurn_rad), 18e-6));
  EXPECT_FALSE(staysApart(touching, plate, inner, in, turnedAbout(in, kTurn_rad), 0));
}

// Poses around the axis, near it and not near it: parts that are reported apart are apart at both ends and in
// between.
TEST(SpinClearance, NeverCallsApartWhatOverlaps) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-1, 1);
  const Body outer(ring(5.1e-3));
  int apart = 0, overlapping = 0;
  for (const int sides : {3, 7, 48}) {
    const Body inner(shaft(5e-3, sides));
    SpinClearance spin;
    for (int i = 0; i < 1500; ++i) {
      const double scale = std::pow(off(random), 2);  // from hardly moved to more than there is room for
      const auto near = [&](double by) {
        return Pose(rotationFromVector(by * 12e-3 * test::drawnVector(off, random)),
                    by * 100e-6 * test::drawnVector(off, random));
      };
      const double angle_rad = 3 * off(random);
      const Pose start = turnedAbout(near(scale), angle_rad),
                 end = turnedAbout(near(scale), angle_rad + kTurn_rad * off(random));
      if (i < 8) {
        staysApart(spin, outer, inner, Pose(), turnedAbout(Pose(), kTurn_rad));
        continue;
      }
      const bool is_apart = spin.staysApart(outer.features, inner.features, start, end, kLeastGap_m);
      double depth_m = 0;
      for (const double share : {0.0, 0.5, 1.0}) {
        const Mat3 R = rotationFromVector(share * rotationVector(end.R * start.R.transpose())) * start.R;
        const Pose at(R, (1 - share) * start.p + share * end.p);
        depth_m = std::max(depth_m, deepestOverlap(outer.exact, Pose(), inner.exact, at).depth_m);
      }
      apart += is_apart ? 1 : 0;
      overlapping += depth_m > 0 ? 1 : 0;
      ASSERT_FALSE(is_apart && depth_m > 0) << sides << " sides, " << i << ": " << depth_m;
    }
  }
  EXPECT_GT(apart, 100);
  EXPECT_GT(overlapping, 100);
}

TEST(SpinClearance, SweepsEdgesOfFacetsWithoutArea) {
  const Body outer(ring(5.5e-3));
  Mesh mesh = shaft(5e-3, 48);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const double x_m : {4e-3, 5.5e-3, 7e-3}) mesh.vertices.emplace_back(x_m, 0, 0);
  FeatureSet features;
  features.append(mesh, Pose(), false);
  features.build();
  SpinClearance without, with;
  const Pose end = turnedAbout(Pose(), kTurn_rad);
  bool is_apart = false;
  for (int i = 0; i < 8; ++i)
    is_apart = without.staysApart(outer.features, features, Pose(), end, kLeastGap_m);
  EXPECT_TRUE(is_apart);
  mesh.triangles.push_back({first, first + 1, first + 2});
  FeatureSet with_edge;
  with_edge.append(mesh, Pose(), false);
  with_edge.build();
  for (int i = 0; i < 8; ++i)
    EXPECT_FALSE(with.staysApart(outer.features, with_edge, Pose(), end, kLeastGap_m));
}

// A single step in which the part is pushed aside does not cause a search for another axis that is of no use.
TEST(SpinClearance, KeepsTheAxisThatItKnows) {
  const Body outer(ring(5.1e-3)), inner(shaft(5e-3, 48));
  SpinClearance spin;
  const Pose end = turnedAbout(Pose(), kTurn_rad);
  EXPECT_TRUE(staysApart(spin, outer, inner, Pose(), end));
  const Pose aside(Mat3::Identity(), Vec3(95e-6, 0, 0));
  for (int i = 0; i < 100; ++i)
    EXPECT_FALSE(
        spin.staysApart(outer.features, inner.features, aside, turnedAbout(aside, kTurn_rad), kLeastGap_m));
  EXPECT_TRUE(spin.staysApart(outer.features, inner.features, Pose(), end, kLeastGap_m));
}

TEST(SpinClearance, SaysNothingOfPartsThatDoNotTurn) {
  const Body outer(ring(5.1e-3)), inner(shaft(5e-3, 48));
  SpinClearance spin;
  const Pose aside(Mat3::Identity(), Vec3(0, 0, 1e-4));
  for (int i = 0; i < 100; ++i)
    EXPECT_FALSE(spin.staysApart(outer.features, inner.features, Pose(), aside, 0));
}

}  // namespace
}  // namespace vps
