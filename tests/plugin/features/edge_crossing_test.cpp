// SPDX-License-Identifier: BSD-3-Clause
#include "vps/edge_crossing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "query/features/feature_pair.h"
#include "support/lathe.h"
#include "support/random_draw.h"
#include "support/screw.h"
#include "vps/mesh_distance.h"

namespace vps {
namespace {

// Lengths in this file are of the order of 1 and results are sums of a few products: 1e-12 is thousands of
// roundings.
constexpr double kRounding = 1e-12;

EdgeSet edgesOf(const Mesh& mesh) {
  std::vector<EdgeSegment> segments;
  appendEdges(mesh, Pose{}, 0, segments);
  return EdgeSet(std::move(segments));
}

std::vector<EdgeCrossing> crossings(const EdgeSet& a, const EdgeSet& b, const Pose& X_ab, double cutoff) {
  std::vector<EdgeCrossing> out;
  findCrossings(a, b, X_ab, {cutoff, cutoff, X_ab}, out);
  return out;
}

Pose randomPose(std::mt19937& random, double reach) {
  std::normal_distribution<double> normal;
  const Vec3 p = test::drawnVector(normal, random);
  return {test::drawnRotation(normal, random), Vec3(reach * p.normalized())};
}

Mat3 turned(const Vec3& axis, double angle_rad) {
  return rotationFromVector(angle_rad * axis);
}

TEST(EdgeSet, ABoxHasTwelveEdgesAndNoneOnItsDiagonals) {
  const EdgeSet edges = edgesOf(makeBox({1, 2, 3}));
  ASSERT_EQ(edges.segments().size(), 12U);
  double length = 0;
  for (const EdgeSegment& s : edges.segments()) length += (s.to - s.from).norm();
  EXPECT_NEAR(length, 4 * (1 + 2 + 3), kRounding);
}

TEST(EdgeSet, GroovesAndFacetBordersOfRoundFacesAreNotEdges) {
  // A flanged bush of 24 flats, 15 degrees apart. Expected: its five convex rims, but not the root of the
  // flange.
  const EdgeSet edges = edgesOf(test::lathe({{6, 0}, {15, 0}, {15, 4}, {9, 4}, {9, 20}, {6, 20}}, 24));
  EXPECT_EQ(edges.segments().size(), 5U * 24U);
}

TEST(EdgeSet, FindsTheSegmentsAtAPoint) {
  const EdgeSet edges = edgesOf(makeBox({1, 2, 3}));
  const auto countAt = [&](const Vec3& p) {
    int count = 0;
    edges.tree().forEachNear(p, 1e-9, [&](std::uint32_t) { ++count; });
    return count;
  };
  EXPECT_EQ(countAt({0.5, 0.3, 1.5}), 1);
  EXPECT_EQ(countAt({0.5, 1, 1.5}), 3) << "a corner";
  EXPECT_EQ(countAt({0.5, 0, 0}), 0) << "the middle of a face";
}

// Two bars that stand on an edge, one across the other.
TEST(EdgeCrossing, OfTwoBarsLiesAtTheirContact) {
  const EdgeSet along_x = edgesOf(makeBox({10, 1, 1})), along_y = edgesOf(makeBox({1, 10, 1}));
  const double half = std::sqrt(0.5);  // from the axis to an edge
  for (const double gap : {0.01, 0.0, -0.01}) {
    // In the frame of the upper bar, which is turned by 45 degrees about its length.
    const Pose X_W0(turned(Vec3::UnitX(), std::numbers::pi / 4), Vec3(0.3, 0.2, half + gap)),
        X_W1(turned(Vec3::UnitY(), std::numbers::pi / 4), Vec3(0, 0, -half));
    const auto found = crossings(along_x, along_y, X_W0.inverse() * X_W1, 0.05);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].gap_m, gap, kRounding);
    EXPECT_LT((X_W0.R * found[0].n - Vec3::UnitZ()).norm(), kRounding);
    EXPECT_LT((X_W0 * found[0].p[0] - Vec3(0, 0.2, gap)).norm(), kRounding);
    EXPECT_LT((X_W0 * found[0].p[1] - Vec3(0, 0.2, 0)).norm(), kRounding);
  }
}

TEST(EdgeCrossing, IsFoundUpToTheGivenDepth) {
  const EdgeSet along_x = edgesOf(makeBox({10, 1, 1})), along_y = edgesOf(makeBox({1, 10, 1}));
  const Pose X_W0(turned(Vec3::UnitX(), std::numbers::pi / 4), Vec3(0.3, 0.2, 2 * std::sqrt(0.5) - 0.1)),
      X_W1(turned(Vec3::UnitY(), std::numbers::pi / 4), Vec3::Zero());
  std::vector<EdgeCrossing> out;
  const Pose X_01 = X_W0.inverse() * X_W1;
  findCrossings(along_x, along_y, X_01, {0.01, 0.09, X_01}, out);
  EXPECT_TRUE(out.empty());
  findCrossings(along_x, along_y, X_01, {0.01, 0.11, X_01}, out);
  ASSERT_EQ(out.size(), 1U);
  EXPECT_NEAR(out[0].gap_m, -0.1, kRounding);
}

TEST(EdgeCrossing, DoesNotExistWhereAFaceLiesOnAnEdge) {
  // The upper bar lies flat on the lower one's edge: its own edges do not cross that edge except near its
  // ends.
  const EdgeSet bar = edgesOf(makeBox({10, 1, 1}));
  const double half = std::sqrt(0.5);
  const Pose X_01(Mat3(turned(Vec3::UnitZ(), 0.5) * turned(Vec3::UnitX(), std::numbers::pi / 4)),
                  Vec3(0, 0, -0.5 - half - 0.01));
  for (const EdgeCrossing& c : crossings(bar, bar, X_01, 0.05))
    EXPECT_NEAR(std::abs(c.n.z()), 1, 0.02 + kRounding) << "the rims of the face that lies on it, at most";
}

TEST(EdgeCrossing, IsTheSameWithThePartsExchanged) {
  const EdgeSet a = edgesOf(makeBox({1, 2, 3})),
                b = edgesOf(test::lathe({{0, 0}, {1, 0}, {1, 2}, {0, 2}}, 17));
  std::mt19937 random(1);
  std::size_t seen = 0;
  for (int k = 0; k < 3000; ++k) {
    const Pose X_ab = randomPose(random, 1.5);
    const auto forth = crossings(a, b, X_ab, 0.3), back = crossings(b, a, X_ab.inverse(), 0.3);
    ASSERT_EQ(forth.size(), back.size());
    seen += forth.size();
    for (const EdgeCrossing& f : forth) {
      const auto same = std::find_if(back.begin(), back.end(), [&](const EdgeCrossing& r) {
        return r.edge[0] == f.edge[1] && r.edge[1] == f.edge[0];
      });
      ASSERT_NE(same, back.end());
      EXPECT_NEAR(same->gap_m, f.gap_m, 1e3 * kRounding);  // at a sine of 0.087 errors are a hundredfold
      EXPECT_LT((X_ab.R * same->n + f.n).norm(), 1e3 * kRounding);
    }
  }
  EXPECT_GT(seen, 100U);
}

TEST(EdgeCrossing, TheHierarchyFindsWhatAnExhaustiveSearchFinds) {
  const Mesh part = test::lathe({{0.6, 0}, {1.5, 0}, {1.5, 0.4}, {0.9, 0.4}, {0.9, 2}, {0.6, 2}}, 40);
  const EdgeSet edges = edgesOf(part);
  std::vector<EdgeSet> alone;
  for (const EdgeSegment& s : edges.segments()) alone.emplace_back(std::vector<EdgeSegment>{s});
  std::mt19937 random(2);
  std::size_t seen = 0;
  for (int k = 0; k < 80; ++k) {
    const Pose X = randomPose(random, 1.2);
    const auto found = crossings(edges, edges, X, 0.4);
    std::size_t i = 0;
    for (std::uint32_t e0 = 0; e0 < alone.size(); ++e0)
      for (std::uint32_t e1 = 0; e1 < alone.size(); ++e1)
        for (const EdgeCrossing& truth : crossings(alone[e0], alone[e1], X, 0.4)) {
          ASSERT_LT(i, found.size());
          EXPECT_EQ(found[i].edge[0], e0);
          EXPECT_EQ(found[i].edge[1], e1);
          EXPECT_EQ(found[i].gap_m, truth.gap_m);
          ++i;
        }
    EXPECT_EQ(i, found.size());
    seen += i;
  }
  EXPECT_GT(seen, 50U);
}

// True if a part of the segment is in the box about the origin.
bool pierces(const Vec3& from, const Vec3& to, const Vec3& size) {
  double first = 0, last = 1;
  for (int k = 0; k < 3; ++k) {
    const double way = to[k] - from[k], low = (-size[k] / 2 - from[k]) / way,
                 high = (size[k] / 2 - from[k]) / way;
    first = std::max(first, std::min(low, high));
    last = std::min(last, std::max(low, high));
  }
  return first < last;
}

// The distance of separate boxes is that of a corner to the other box, or that of two edges. If no corner is
// nearest, a crossing gives the distance, and no crossing gives much less.
TEST(EdgeCrossing, GivesTheDistanceOfBoxesWhereNoCornerIsNearest) {
  const Vec3 size0(1, 2, 3), size1(2, 1.5, 1);
  const Mesh box0 = makeBox(size0), box1 = makeBox(size1);
  const MeshDistance to0(box0), to1(box1);
  const EdgeSet edges0 = edgesOf(box0), edges1 = edgesOf(box1);
  std::mt19937 random(3);
  int edge_cases = 0;
  for (int k = 0; k < 2000; ++k) {
    const Pose X_01 = randomPose(random, 2.6);
    double corner = 1e300, edge = 1e300, sine = 0;
    for (const Vec3& v : box1.vertices) corner = std::min(corner, to0.signedDistance(X_01 * v));
    for (const Vec3& v : box0.vertices) corner = std::min(corner, to1.signedDistance(X_01.inverse() * v));
    // Reference by exhaustive search: nearest points of segments, and the distance of their lines.
    for (const EdgeSegment& s0 : edges0.segments())
      for (const EdgeSegment& s1 : edges1.segments()) {
        const Vec3 a = s0.from, d0 = s0.to - s0.from, b = X_01 * s1.from, d1 = X_01.R * (s1.to - s1.from);
        Eigen::Matrix<double, 3, 2> M;
        M << d0, -d1;
        const Eigen::Vector2d at = (M.transpose() * M).ldlt().solve(M.transpose() * (b - a));
        const double apart = (a + at[0] * d0 - b - at[1] * d1).norm();
        if (at.minCoeff() <= 0 || at.maxCoeff() >= 1 || apart >= edge) continue;
        edge = apart;
        sine = d0.normalized().cross(d1.normalized()).norm();
      }
    if (corner <= 0 || edge >= corner || edge > 0.5 || sine < 0.1) continue;  // found by shell points
    // The distance of overlapping boxes without a corner inside is not defined: an edge pierces a face.
    bool overlaps = false;
    for (const EdgeSegment& s : edges0.segments())
      overlaps |= pierces(X_01.inverse() * s.from, X_01.inverse() * s.to, size1);
    for (const EdgeSegment& s : edges1.segments()) overlaps |= pierces(X_01 * s.from, X_01 * s.to, size0);
    if (overlaps) continue;
    double nearest = 1e300;  // smallest difference from the true distance
    for (const EdgeCrossing& c : crossings(edges0, edges1, X_01, 0.5)) {
      if (c.gap_m < 0) continue;
      nearest = std::min(nearest, std::abs(c.gap_m - edge));
      // A crossing may lie past the ends of both edges, by a tenth of its gap and a micrometre; it is then
      // that far along each edge from points of the bodies.
      EXPECT_LE(edge, std::hypot(c.gap_m, 2 * (0.1 * c.gap_m + 1e-6)) + 1e3 * kRounding);
    }
    EXPECT_LE(nearest, 1e3 * kRounding);
    ++edge_cases;
  }
  EXPECT_GT(edge_cases, 100);
}

// A bar's edge that goes around a rim of chords always crosses the rim, even at the joints.
TEST(EdgeCrossing, IsFoundAtTheJointsOfARim) {
  const EdgeSet disc = edgesOf(test::lathe({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 96)),
                bar = edgesOf(makeBox({1, 4, 1}));
  // The bar lies on its edge across the rim of the disc's top face.
  for (int k = 0; k <= 400; ++k) {
    const double angle_rad = 0.2 * k / 400;
    const Pose X_W1(turned(Vec3::UnitY(), std::numbers::pi / 4), Vec3(0.9, 0, 1 + std::sqrt(0.5) + 1e-7));
    const Pose X(turned(Vec3::UnitZ(), angle_rad), Vec3::Zero());
    const auto found = crossings(disc, bar, X * X_W1, 1e-3);
    const bool both = std::count_if(found.begin(), found.end(), [](const EdgeCrossing& c) {
                        return std::abs(c.gap_m - 1e-7) < 1e-9;
                      }) >= 2;
    EXPECT_TRUE(both) << "at " << angle_rad;
  }
}

TEST(EdgeCrossing, OfTwoHollowEdgesAtTheirJointsIsFoundAtAnyDepth) {
  // Two links of a chain: each link's inner edge is a polygon, and they hang in each other's corner. The
  // lines of the segments then cross beyond the joint, by the gap times the tangent of half the turn of 17
  // degrees.
  const double half_rad = 8.5 * std::numbers::pi / 180;
  const auto hollow = [&](const Mat3& R) {
    std::vector<EdgeSegment> segments;
    for (const double side : {-1.0, 1.0}) {
      EdgeSegment s;
      s.to = R * Vec3(side * std::cos(half_rad), 0, std::sin(half_rad));
      s.outward = R * Vec3(-side * std::sin(half_rad), 0, std::cos(half_rad));
      const double slope = 0.3;  // of the faces beside the edge
      for (int i = 0; i < 2; ++i) s.into[i] = R * Vec3(0, i == 0 ? 1 : -1, -slope).normalized();
      s.ends[0] = false;
      segments.push_back(s);
    }
    return EdgeSet(std::move(segments));
  };
  const EdgeSet below = hollow(Mat3::Identity());
  const Mat3 over = turned(Vec3::UnitZ(), std::numbers::pi / 2) * turned(Vec3::UnitX(), std::numbers::pi);
  const EdgeSet above = hollow(over);
  for (const double overlap : {1e-3, 1e-2, 1e-1}) {
    const auto found = crossings(below, above, Pose::translation({0, 0, -overlap}), 0.5);
    ASSERT_FALSE(found.empty()) << overlap;
    EXPECT_LT(found[0].gap_m, -0.9 * overlap);
  }
}

// Two roofs whose ridges cross at a right angle, 100 um apart. Crossings are within the cutoff only if their
// edges come nearer in the step, and not if they have passed each other's ends by the end of the step.
TEST(FindCrossings, EdgesThatComeNearInTheStepAreFound) {
  const double gap_m = 100e-6, cutoff_m = 20e-6;
  EdgeSegment s;
  s.from = {-5e-3, 0, 0};
  s.to = {5e-3, 0, 0};
  s.outward = Vec3::UnitZ();
  for (int i = 0; i < 2; ++i) s.into[i] = Vec3(0, i == 0 ? 1 : -1, -1).normalized();
  const EdgeSet below(std::vector<EdgeSegment>{s}), above = below;
  const Mat3 over = turned(Vec3::UnitZ(), std::numbers::pi / 2) * turned(Vec3::UnitX(), std::numbers::pi);
  const Pose start(over, Vec3(0, 0, gap_m));
  const auto found = [&](const Vec3& step_m) {
    std::vector<EdgeCrossing> out;
    findCrossings(below, above, start, {cutoff_m, cutoff_m, Pose(over, start.p + step_m)}, out);
    return out.size();
  };
  EXPECT_EQ(found({0, 0, 0}), 0u);
  EXPECT_EQ(found({0, 0, -(gap_m - 2 * cutoff_m)}), 0u);
  EXPECT_EQ(found({0, 0, -(gap_m - 0.9 * cutoff_m)}), 1u);
  EXPECT_EQ(found({1e-3, 1e-3, -2 * gap_m}), 1u);
  EXPECT_EQ(found({6e-3, 0, -2 * gap_m}), 0u);
}

test::ThreadShape coarseThread() {
  test::ThreadShape thread;
  thread.columns = 48;
  thread.rows_per_pitch = 16;
  thread.length_m = 3 * thread.pitch_m;
  return thread;
}

struct NutAndRod {
  test::ThreadShape thread = coarseThread();
  EdgeSet nut = edgesOf(test::makeNut(thread, 1.8 * thread.major_m)),
          rod = edgesOf(test::makeThreadedRod(thread));
};

// The rod of a thread turns into its nut, fast and slowly, and jumps.
TEST(FindCrossings, AMemoryDoesNotChangeTheAnswer) {
  const NutAndRod parts;
  const test::ThreadShape& thread = parts.thread;
  const EdgeSet &nut = parts.nut, &rod = parts.rod;
  CrossingMemory memory;
  std::size_t count = 0;
  double turn_rad = 0;
  const auto poseAt = [&](int i) {
    return Pose{rotationFromVector(Vec3(2e-3 * std::sin(0.1 * i), 0, turn_rad)),
                Vec3(50e-6 * std::sin(0.3 * i), 0, turn_rad / (2 * std::numbers::pi) * thread.pitch_m)};
  };
  for (int i = 0; i < 300; ++i) {
    const Pose X = poseAt(i);
    turn_rad += i % 100 == 50 ? 1.0 : i < 150 ? 1e-3 : 2e-2;
    // The range has the next step, or a step of zero.
    const CrossingRange range{i % 7 == 0 ? 120e-6 : 30e-6, 60e-6,
                              i % 3 == 0 || i % 100 == 50 ? X : poseAt(i + 1)};
    std::vector<EdgeCrossing> with, without;
    findCrossings(nut, rod, X, range, without);
    findCrossings(nut, rod, X, range, with, &memory);
    ASSERT_EQ(with.size(), without.size()) << i;
    for (std::size_t k = 0; k < with.size(); ++k) {
      ASSERT_EQ(with[k].edge[0], without[k].edge[0]);
      ASSERT_EQ(with[k].edge[1], without[k].edge[1]);
      ASSERT_EQ(with[k].gap_m, without[k].gap_m);
    }
    count += with.size();
  }
  EXPECT_GT(count, 50u);
}

}  // namespace
}  // namespace vps
