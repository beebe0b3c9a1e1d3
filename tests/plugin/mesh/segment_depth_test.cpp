// SPDX-License-Identifier: BSD-3-Clause
#include "vps/mesh_overlap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/analytic.h"
#include "support/faulty_meshes.h"

namespace vps {
namespace {

constexpr double kCertain_m = 0.5e-6;
// Coordinates of centimetres are rounded to 2e-18 m; a distance is a few operations on them.
constexpr double kRounding_m = 1e-15;

Vec3 in(test::RandomPoints& random, double half_m) {
  return random.inBox(Vec3::Constant(half_m));
}

TEST(SegmentDepth, TheEndOfAnEdgeInABoxIsMeasuredExactly) {
  const Solid box(makeBox(Vec3(0.02, 0.02, 0.02)));
  const PointDepth found = deepestOnSegment(box, {0.001, 0, 0.03}, {0.002, 0, 0.01 - 3e-6}, kCertain_m);
  EXPECT_NEAR(found.depth_m, 3e-6, kRounding_m);
  EXPECT_LE((found.p_S - Vec3(0.002, 0, 0.01 - 3e-6)).norm(), kRounding_m);
}

TEST(SegmentDepth, AnEdgeThatLiesInAFaceOverItsWholeLengthHasItsDepth) {
  const Solid box(makeBox(Vec3(0.3, 0.2, 0.1)));
  const PointDepth found =
      deepestOnSegment(box, {-0.149, -0.09, 0.05 - 2e-6}, {0.149, 0.09, 0.05 - 2e-6}, kCertain_m);
  EXPECT_NEAR(found.depth_m, 2e-6, kRounding_m);
}

TEST(SegmentDepth, AnEdgeThatPassesThroughIsDeepestWhereItIsFarthestFromTheFaces) {
  const Solid box(makeBox(Vec3(0.02, 0.02, 0.01)));
  // A segment across the box half way up: 5 mm below the top where it is at least that far from the sides.
  const PointDepth found = deepestOnSegment(box, {-0.03, 0, 0}, {0.03, 0.001, 0}, kCertain_m);
  EXPECT_NEAR(found.depth_m, 0.005, kCertain_m);
}

TEST(SegmentDepth, AnEdgeThatIsNearButOutsideHasNone) {
  const Solid bore(makeTube(0.02, 0.01, 0.03, 64));
  const double flat_m = 0.01 * std::cos(M_PI / 64);
  EXPECT_EQ(deepestOnSegment(bore, {flat_m - 2e-6, 0, -0.02}, {flat_m - 2e-6, 0, 0.02}, kCertain_m).depth_m,
            0);
}

// Long and short segments through and beside each kind of faulty mesh, compared with many points of each
// segment.
TEST(SegmentDepth, NoPointOfASegmentIsDeeperThanFound) {
  test::RandomPoints random(71);
  constexpr int kSamples = 400;
  int inside = 0;
  for (const test::FaultyMesh& made : test::faultyMeshes()) {
    const Solid solid(made.mesh);
    const Box box = bounds(solid.mesh());
    for (int i = 0; i < 40; ++i) {
      const Vec3 a = in(random, 0.6 * box.size().maxCoeff()) + box.center();
      const Vec3 b = i % 2 == 0 ? Vec3(in(random, 0.6 * box.size().maxCoeff()) + box.center())
                                : Vec3(a + in(random, 1e-4));
      const PointDepth found = deepestOnSegment(solid, a, b, kCertain_m);
      double sampled_m = 0;
      bool is_by_hole = false;
      for (int k = 0; k <= kSamples; ++k) {
        const Vec3 p = a + double(k) / kSamples * (b - a);
        is_by_hole |= made.isByHole && made.isByHole(p);
        sampled_m = std::max(sampled_m, -solid.signedDistance(p));
      }
      if (is_by_hole) continue;  // the signed distance jumps in a hole
      EXPECT_GE(found.depth_m, sampled_m - kCertain_m) << made.fault << ", segment " << i;
      const double there_m = found.depth_m > 0 ? -solid.signedDistance(found.p_S) : 0;
      EXPECT_NEAR(found.depth_m, there_m, kRounding_m) << made.fault;
      inside += found.depth_m > 0;
    }
  }
  EXPECT_GT(inside, 300);
}

// Segments through the seams of long, thin facets, where the rounding error of a crossing is greatest: each
// enters and leaves a needle of 128 sides through two of its side edges.
TEST(SegmentDepth, ASegmentThroughTheSeamsOfThinFacetsIsNotLost) {
  test::RandomPoints random(73);
  constexpr int kSides = 128;
  constexpr double kRadius_m = 0.2e-3, kHeight_m = 0.1;
  const Pose X = random.pose(0.05);
  const Solid needle(transformed(makeCylinder(kRadius_m, kHeight_m, kSides), X));
  for (int i = 0; i < 3000; ++i) {
    const auto onSeam = [&](int side) {
      const double angle_rad = 2 * M_PI * side / kSides;
      return Vec3(kRadius_m * std::cos(angle_rad), kRadius_m * std::sin(angle_rad),
                  0.4 * kHeight_m * random.unit());
    };
    const int in = i % kSides, out = in + 3 + i % (kSides / 2);
    const Vec3 p = onSeam(in), q = onSeam(out);
    const Vec3 a = X * (p - 0.3 * (q - p)), b = X * (q + 0.3 * (q - p));
    const double middle_m = -needle.signedDistance(X * (0.5 * (p + q)));
    ASSERT_GT(middle_m, 0);
    EXPECT_GE(deepestOnSegment(needle, a, b, 1e-8).depth_m, middle_m - 1e-8) << i;
  }
}

TEST(SegmentDepth, ASheetHasNoDepthAndAPoseThatIsNoNumberEnds) {
  const Mesh box = makeBox(Vec3(0.02, 0.02, 0.02));
  EXPECT_EQ(deepestOnSegment(Solid::sheet(box), {0, 0, 0}, {0.001, 0, 0.03}, kCertain_m).depth_m, 0);
  const double nan = std::nan("");
  EXPECT_EQ(deepestOnSegment(Solid(box), {0, 0, 0}, {nan, 0, 0.03}, kCertain_m).depth_m, 0);
}

TEST(SegmentDepth, CrossingsAreThoseWithEachTriangle) {
  test::RandomPoints random(72);
  const MeshDistance ball(makeSphere(0.01, 4));
  std::size_t crossings = 0;
  std::vector<double> found, expected;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 a = in(random, 0.02), b = i % 3 == 0 ? Vec3(a + in(random, 1e-3)) : in(random, 0.02);
    found.clear();
    expected.clear();
    ball.appendCrossings(a, b, found);
    for (const auto& t : ball.mesh().triangles) {
      Mesh one;
      for (const std::uint32_t v : t) one.vertices.push_back(ball.mesh().vertices[v]);
      const Vec3 n = (one.vertices[1] - one.vertices[0]).cross(one.vertices[2] - one.vertices[0]);
      const double at_a = n.dot(a - one.vertices[0]), at_b = n.dot(b - one.vertices[0]);
      if ((at_a > 0) == (at_b > 0)) continue;
      const Vec3 q = a + at_a / (at_a - at_b) * (b - a);
      bool is_within = true;
      for (std::size_t k = 0; k < 3; ++k)
        is_within &= (one.vertices[(k + 1) % 3] - one.vertices[k]).cross(q - one.vertices[k]).dot(n) >= 0;
      if (is_within) expected.push_back(at_a / (at_a - at_b));
    }
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(found, expected) << i;
    crossings += expected.size();
  }
  EXPECT_GT(crossings, 500u);
}

}  // namespace
}  // namespace vps
