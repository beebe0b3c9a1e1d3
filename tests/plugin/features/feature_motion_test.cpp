// SPDX-License-Identifier: BSD-3-Clause
#include "vps/feature_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "support/feature_body.h"
#include "support/fit.h"
#include "support/lathe.h"
#include "support/random_draw.h"
#include "vps/mesh_overlap.h"

namespace vps {
namespace {

constexpr double kLeast_m = FeatureMotion::kLeastShare * FeatureMotion::kRest_m;

using Body = test::FeatureBody;

Mesh box(const Vec3& half) {
  return makeBox(2 * half);
}

Mesh tetrahedron(std::mt19937& random) {
  std::uniform_real_distribution<double> inside(-10e-3, 10e-3);
  for (;;) {
    Mesh mesh;
    for (int i = 0; i < 4; ++i) mesh.vertices.push_back(test::drawnVector(inside, random));
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    const double volume_m3 = massProperties(mesh).volume_m3;
    if (volume_m3 < 0)
      for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    if (std::abs(volume_m3) > 1e-8) return mesh;
  }
}

Pose pose(std::mt19937& random, double away_m) {
  std::uniform_real_distribution<double> angle(0, std::numbers::pi);
  const Vec3 axis = test::drawnDirection(random);
  return {rotationFromVector(angle(random) * axis), away_m * test::drawnDirection(random)};
}

std::vector<FeatureContact> check(const Body& a, const Body& b, const Pose& start, const Pose& end) {
  FeatureMotion motion;
  std::vector<FeatureContact> found;
  motion.check(a.features, b.features, start, end, false, found);
  return found;
}

TEST(FeatureSet, HasTheCornersAndEdgesOfABox) {
  const Body a(box(Vec3(1e-3, 2e-3, 3e-3)));
  EXPECT_EQ(a.features.corners().size(), 8u);
  EXPECT_EQ(a.features.edges().size(), 12u);  // not the diagonals
  EXPECT_EQ(a.features.facets().size(), 12u);
  for (std::uint32_t i = 0; i < 8; ++i) EXPECT_EQ(a.features.edgesAt(i).size(), 3u);
  for (std::uint32_t i = 0; i < 12; ++i) EXPECT_FALSE(a.features.isCurved(i));
}

/// A prism over the polygon with corners at these angles of a circle.
Mesh prism(const std::vector<double>& angles_rad) {
  const auto count = static_cast<int>(angles_rad.size());
  Mesh mesh = makeCylinder(10e-3, 8e-3, count);
  for (Vec3& v : mesh.vertices) {
    const double radius_m = std::hypot(v.x(), v.y()),
                 turns = std::atan2(v.y(), v.x()) / (2 * std::numbers::pi);
    const auto i = static_cast<std::size_t>((std::lround(turns * count) + count) % count);
    v.x() = radius_m * std::cos(angles_rad[i]);
    v.y() = radius_m * std::sin(angles_rad[i]);
  }
  return mesh;
}

std::vector<double> evenly(int count) {
  std::vector<double> angles_rad;
  for (int i = 0; i < count; ++i) angles_rad.push_back(2 * std::numbers::pi * i / count);
  return angles_rad;
}

std::size_t curvedFacets(const FeatureSet& features) {
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < features.facets().size(); ++i)
    if (features.isCurved(i)) ++count;
  return count;
}

std::size_t slightEdges(const FeatureSet& features) {
  return static_cast<std::size_t>(std::count_if(features.edges().begin(), features.edges().end(),
                                                [](const FeatureEdge& edge) { return edge.is_slight; }));
}

// Edges of both rims are listed, and edges between the sides only if they are sharp.
TEST(FeatureSet, SidesThatTurnByLessThanEightDegreesAreACurve) {
  const Body coarse(prism(evenly(40))), fine(prism(evenly(48)));  // 9 and 7.5 degrees
  EXPECT_EQ(coarse.features.edges().size(), 3 * 40u);
  EXPECT_EQ(slightEdges(coarse.features), 0u);
  EXPECT_EQ(curvedFacets(coarse.features), 0u);
  EXPECT_EQ(slightEdges(fine.features), 48u);
  EXPECT_EQ(curvedFacets(fine.features), 2 * 48u);
}

// Edges beside a side of length w that turns by an angle stand out by w angle / 8: for 0.6 mm and 7.5 degrees
// by 10 um, for 80 um and 0.9 degrees by 0.15 um.
TEST(FeatureSet, EdgesOfACurveAreFeaturesIfTheyStandOut) {
  const Body coarse(prism(evenly(48))), fine(prism(evenly(800)));
  EXPECT_EQ(coarse.features.edges().size(), 3 * 48u);
  EXPECT_EQ(fine.features.edges().size(), 2 * 800u);
  EXPECT_EQ(curvedFacets(fine.features), 2 * 800u);
}

// Chords of a circle turn by half the sum of the angles that they span.
TEST(FeatureSet, ALoneKinkIsASharpEdge) {
  for (const double kink_rad : {0.02, 0.1, 0.2, 0.3}) {
    std::vector<double> angles_rad = evenly(6);
    // Two short sides of kink_rad each after the corner at 0.
    angles_rad.insert(angles_rad.begin() + 1, {kink_rad, 2 * kink_rad});
    const Body body(prism(angles_rad));
    EXPECT_EQ(body.features.edges().size(), 3 * 8u) << kink_rad;
    EXPECT_EQ(curvedFacets(body.features), 0u) << kink_rad;
  }
  // Three sides are a curve: its two inner edges are slight, and its three sides of two triangles are curved.
  std::vector<double> angles_rad = evenly(6);
  angles_rad.insert(angles_rad.begin() + 1, {0.1, 0.2, 0.3});
  const Body body(prism(angles_rad));
  EXPECT_EQ(body.features.edges().size(), 3 * 9u);
  EXPECT_EQ(slightEdges(body.features), 2u);
  EXPECT_EQ(curvedFacets(body.features), 6u);
}

// A tetrahedron that stands on a corner at the origin.
Mesh tetrahedron() {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {3e-3, -2e-3, 5e-3}, {3e-3, 2e-3, 5e-3}, {-3e-3, 0, 5e-3}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
  return mesh;
}

// A corner at height h above a face falls by d > h. The check ends the motion at a gap of kLeast_m, which is
// after the fraction (h - kLeast_m) / d of the motion.
TEST(FeatureMotion, ACornerMeetsAFaceWhereTheFormulaSays) {
  const Body floor(box(Vec3(20e-3, 20e-3, 5e-3)));
  const Body tip(tetrahedron());
  const double height_m = 10e-6, fall_m = 100e-6, slide_m = 300e-6;
  const Pose start = Pose::translation(Vec3(0, 0, 5e-3 + height_m));
  const Pose end = Pose::translation(Vec3(slide_m, 0, 5e-3 + height_m - fall_m));
  // The tip is part 0, so the poses are those of the floor in the tip's frame.
  const auto found = check(tip, floor, start.inverse(), end.inverse());
  ASSERT_EQ(found.size(), 1u);
  const FeatureContact& c = found[0];
  EXPECT_EQ(c.kind, FeatureContact::Kind::CornerOnFacet);
  // The search may stop early by a tenth of kLeast_m.
  EXPECT_NEAR(c.share, (height_m - kLeast_m) / fall_m, 0.1 * kLeast_m / fall_m);
  EXPECT_NEAR(c.start_m, height_m, 1e-15);
  EXPECT_LE((c.n - Vec3::UnitZ()).norm(), 1e-9);
  EXPECT_LE(c.p[0].norm(), 1e-12);
  EXPECT_NEAR(c.gap_m(start.inverse()), height_m, 1e-12);
  EXPECT_NEAR(c.gap_m(end.inverse()), height_m - fall_m, 1e-12);
}

// Moves the same corner to other places above the face: height and place follow the formula, while it is near
// and outside.
TEST(FeatureMotion, AContactIsMeasuredAgainAtAnotherPose) {
  const Body floor(box(Vec3(20e-3, 20e-3, 5e-3)));
  const Body tip(tetrahedron());
  const auto at = [](double x_m, double height_m) {
    return Pose::translation(Vec3(x_m, 2e-3, 5e-3 + height_m)).inverse();
  };
  const auto found = check(tip, floor, at(1e-3, 1e-6), at(1e-3, -1e-6));
  ASSERT_EQ(found.size(), 1u);
  FeatureContact c = found[0];
  ASSERT_TRUE(measureAgain(tip.features, floor.features, at(1.5e-3, 1.7e-6), 2e-6, c));
  EXPECT_EQ(c.feature[0], found[0].feature[0]);
  EXPECT_EQ(c.feature[1], found[0].feature[1]);
  EXPECT_NEAR(c.start_m, 1.7e-6, 1e-12);
  EXPECT_NEAR(c.gap_m(at(1.5e-3, 1.7e-6)), 1.7e-6, 1e-12);
  EXPECT_LE((c.p[1] - Vec3(1.5e-3, 2e-3, 5e-3)).norm(), 1e-12);
  // Not valid: too far, of unknown direction, and behind the face.
  for (const double height_m : {2.3e-6, 0.5e-9, -1e-6}) {
    FeatureContact away = found[0];
    EXPECT_FALSE(measureAgain(tip.features, floor.features, at(1e-3, height_m), 2e-6, away)) << height_m;
  }
}

// A tip that is far away when the step begins: a long motion is examined in segments.
TEST(FeatureMotion, AFastCornerMeetsAFaceWhereTheFormulaSays) {
  const Body floor(box(Vec3(20e-3, 20e-3, 5e-3)));
  const Body tip(tetrahedron());
  const double height_m = 7.123e-3, fall_m = 50e-3, slide_m = 5e-3;
  const Pose start = Pose::translation(Vec3(0, 0, 5e-3 + height_m));
  const Pose end = Pose::translation(Vec3(slide_m, 0, 5e-3 + height_m - fall_m));
  const auto found = check(tip, floor, start.inverse(), end.inverse());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].share, (height_m - kLeast_m) / fall_m, 0.1 * kLeast_m / fall_m);
  EXPECT_NEAR(found[0].start_m, height_m, 1e-15);
  EXPECT_NEAR(found[0].gap_m(start.inverse()), height_m, 1e-12);
  EXPECT_NEAR(found[0].gap_m(end.inverse()), height_m - fall_m, 1e-12);
  // Past the floor's rim the tip meets nothing.
  const Pose beside = Pose::translation(Vec3(31e-3, 0, 5e-3 + height_m));
  EXPECT_TRUE(check(tip, floor, beside.inverse(), (Pose::translation(Vec3(0, 0, -fall_m)) * beside).inverse())
                  .empty());
}

// Two roofs whose ridges cross at a right angle touch at no corner.
TEST(FeatureMotion, AnEdgeMeetsAnEdge) {
  Mesh roof;
  roof.vertices = {{-10e-3, 0, 0},       {10e-3, 0, 0},          {-10e-3, 4e-3, -4e-3},
                   {10e-3, 4e-3, -4e-3}, {-10e-3, -4e-3, -4e-3}, {10e-3, -4e-3, -4e-3}};
  roof.triangles = {{0, 1, 3}, {0, 3, 2}, {0, 5, 1}, {0, 4, 5}, {2, 3, 5}, {2, 5, 4}, {0, 2, 4}, {1, 5, 3}};
  const Body below(roof), above(roof);
  // The upper roof is upside down, and turned by a quarter about z.
  const Mat3 R =
      rotationFromVector(Vec3(0, 0, std::numbers::pi / 2)) * rotationFromVector(Vec3(std::numbers::pi, 0, 0));
  const Pose start(R, Vec3(1e-3, 2e-3, 20e-6)), end(R, Vec3(1e-3, 2e-3, -30e-6));
  const auto found = check(below, above, start, end);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, FeatureContact::Kind::EdgeOnEdge);
  EXPECT_LE((found[0].normal_0(start) - Vec3(0, 0, -1)).norm(), 1e-9);  // from the upper roof to the lower
  EXPECT_NEAR(found[0].gap_m(end), -30e-6, 1e-12);
}

// An edge that passes over a rim with too small a gap is raised by the missing height, and its direction is
// not changed: where edges first come near, the direction between them leans against the motion. Starts are
// spread over more than a segment.
TEST(FeatureMotion, EdgesThatPassEachOtherTouchWhereTheyAreNearest) {
  const Body floor(box(Vec3(20e-3, 20e-3, 5e-3))), block(box(Vec3(4e-3, 3e-3, 2e-3)));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> height(0.03, 0.94), from_m(15e-3, 25e-3), aside_m(-0.5e-3, 0.5e-3),
      turn_rad(-0.4, 0.4);
  int found = 0;
  for (int i = 0; i < 1000; ++i) {
    const double gap_m = height(random) * FeatureMotion::kRest_m;
    const Pose start(rotationFromVector(Vec3(0, 0, turn_rad(random))), Vec3(from_m(random), 0, 7e-3 + gap_m));
    const Pose end(start.R, start.p - Vec3(3e-3, aside_m(random), 0));
    for (const FeatureContact& c : check(floor, block, start, end)) {
      if (c.kind != FeatureContact::Kind::EdgeOnEdge) continue;
      ++found;
      EXPECT_LE(c.normal_0(start).head<2>().norm(), 1e-6) << i;
      EXPECT_NEAR(c.gap_m(end), gap_m, 4e-9) << i;  // 1e-6 times the path of 3 mm, and rounding
    }
  }
  EXPECT_GE(found, 50);
}

TEST(FeatureMotion, SlidingAtTheRestGapMeetsNothing) {
  const Body floor(box(Vec3(50e-3, 50e-3, 5e-3))), block(box(Vec3(5e-3, 5e-3, 5e-3)));
  FeatureMotion motion;
  std::vector<FeatureContact> found;
  Pose at = Pose::translation(Vec3(0, 0, 10e-3 + FeatureMotion::kRest_m));
  for (int i = 0; i < 40; ++i) {  // over the floor's middle, its diagonals and its rim
    const Pose next(rotationFromVector(Vec3(0, 0, 0.03)) * at.R, at.p + Vec3(1.1e-3, 0.9e-3, 0));
    motion.check(floor.features, block.features, at, next, false, found);
    EXPECT_TRUE(found.empty()) << i;
    found.clear();
    at = next;
  }
}

// A block that comes from beyond an edge, within half of the rest gap above the face behind the edge, slides
// onto that face: a plane along the line from its corner to the edge would stop it. A block that is lower
// than the face hits the side of the floor.
TEST(FeatureMotion, ACornerThatPassesAnEdgeFlushMeetsTheFaceBehindIt) {
  const Body floor(box(Vec3(20e-3, 20e-3, 5e-3))), block(box(Vec3(4e-3, 3e-3, 2e-3)));
  const Mat3 R = rotationFromVector(Vec3(0, 0, 0.3));
  const double leads_m = -(R * Vec3(-4e-3, 3e-3, 0)).x();
  for (const double height_m : {0.15e-6, 0.1e-6, 0.02e-6, 0.0, -1e-6}) {
    const Pose start(R, Vec3(20e-3 + leads_m + 0.05e-3, 1e-3, 7e-3 + height_m));
    const Pose end(R, start.p + Vec3(-0.1e-3, 0.02e-3, 0));
    const bool is_stopped = height_m < 0;
    for (const bool is_swapped : {false, true}) {
      const auto found =
          is_swapped ? check(floor, block, start, end) : check(block, floor, start.inverse(), end.inverse());
      EXPECT_TRUE(!found.empty() || !is_stopped) << is_swapped;
      for (const FeatureContact& c : found) {
        const Vec3 n = is_swapped ? Vec3(-c.normal_0(start)) : Vec3(R * c.normal_0(start.inverse()));
        EXPECT_LE((n - (is_stopped ? Vec3::UnitX() : Vec3::UnitZ())).norm(), 1e-6) << height_m << is_swapped;
      }
    }
  }
}

// The edge of a wedge that leans across the rim of a hole slides straight along the rim: the rim curves away
// to the side, and the wedge's edge enters it by d^2 / 2r, after it has passed the ends of several of the
// rim's edges. Contacts with the passed edges hold the wedge's edge on straight lines, which the rim leaves.
TEST(FeatureMotion, AnEdgeThatSlidesAlongAFineRimMeetsTheEdgeWhereItEnds) {
  constexpr double kRadius_m = 4e-3, kHeight_m = 2e-3;
  const double lean = std::sqrt(0.5);  // the edge leans by 45 degrees in the plane of the hole's axis
  // The edge lies along x, and the wedge grows into +z.
  Mesh wedge;
  for (const double x : {-1.5e-3, 1.5e-3})
    for (const Vec3& p : {Vec3(x, 0, 0), Vec3(x, 1e-3, 1e-3), Vec3(x, -1e-3, 1e-3)})
      wedge.vertices.push_back(p);
  wedge.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  ASSERT_GT(massProperties(wedge).volume_m3, 0);
  Mat3 R;
  R << lean, 0, -lean, 0, 1, 0, lean, 0, lean;
  const Body slider(std::move(wedge));
  for (const int corners : {100, 200, 400, 800}) {
    const Body ring(
        test::lathe({{kRadius_m, 0}, {10e-3, 0}, {10e-3, kHeight_m}, {kRadius_m, kHeight_m}}, corners));
    for (const double slide_m : {0.1e-3, 0.2e-3, 0.35e-3, 0.5e-3}) {
      const double chord_m = 2 * kRadius_m * std::sin(std::numbers::pi / corners);
      if (slide_m < 1.5 * chord_m) continue;
      // The wedge rests on the first edge beside x, near that edge's middle.
      const double turn_rad = std::numbers::pi / corners;
      const Mat3 first = rotationFromVector(Vec3(0, 0, turn_rad));
      const Vec3 middle(kRadius_m * std::cos(turn_rad), 0, kHeight_m), up(-lean, 0, lean);
      const Vec3 at = first * (middle + 1.5 * FeatureMotion::kRest_m * up), way = first * Vec3(0, slide_m, 0);
      const Pose start(first * R, at), end(first * R, at + way);
      // The distance by which the rim leaves the first chord's line, seen along the wedge's edge.
      const double sink_m = lean * slide_m * slide_m / (2 * kRadius_m);
      double deepest_m = 0;
      for (const FeatureContact& c : check(ring, slider, start, end))
        deepest_m = std::min(deepest_m, c.gap_m(end));
      // The plane of two edges leans with the rim by d / r. The chords of a polygon lie within its circle.
      EXPECT_NEAR(deepest_m, 1.5 * FeatureMotion::kRest_m - sink_m,
                  slide_m / kRadius_m * sink_m + chord_m * chord_m / (8 * kRadius_m))
          << corners << " corners, " << 1e3 * slide_m << " mm";
    }
  }
}

// Whenever two tetrahedra overlap at the end of a step, and did not at its start, a contact is reported.
TEST(FeatureMotion, NoOverlapIsMissed) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  int overlaps = 0, reported_in_vain = 0;
  for (int i = 0; i < 6000; ++i) {
    const Body a(tetrahedron(random)), b(tetrahedron(random));
    const Pose start = pose(random, 12e-3 * unit(random));
    if (deepestOverlap(a.exact, Pose(), b.exact, start).depth_m > 0) continue;
    const double travel_m = std::pow(10, -6 + 4 * unit(random));
    const Vec3 axis = test::drawnDirection(random);
    const Pose end(rotationFromVector(0.2 * unit(random) * axis) * start.R,
                   start.p - travel_m * start.p.normalized());
    const bool overlaps_now = deepestOverlap(a.exact, Pose(), b.exact, end).depth_m > 0;
    const bool is_reported = !check(a, b, start, end).empty();
    EXPECT_TRUE(is_reported || !overlaps_now) << i;
    overlaps += overlaps_now;
    reported_in_vain += is_reported && !overlaps_now;
  }
  EXPECT_GT(overlaps, 200);
  // A feature that comes near and passes is not reported, because its gap at the end is large enough.
  EXPECT_LT(reported_in_vain, overlaps);
}

// A corner comes within the rest gap of an edge between two faces and continues into the solid. The corner
// may pass either face's plane first, and its own surface may keep it from touching one of the faces.
TEST(FeatureMotion, NoCornerThatPassesAnEdgeIsMissed) {
  const Vec3 half(3e-3, 2e-3, 2e-3);
  const Body a(box(half));
  std::mt19937 random(3);
  const auto draw = [&](double from, double to) { return std::uniform_real_distribution(from, to)(random); };
  int overlaps = 0, missed = 0;
  for (int i = 0; i < 20000; ++i) {
    const Body b(tetrahedron(random));
    const Mat3 R = rotationFromVector(draw(0, std::numbers::pi) * test::drawnDirection(random));
    const Vec3 corner = R * b.exact.mesh().vertices[0];
    // Places beside the box's edge along x, within the rest gap of both faces' planes, on either side of
    // them.
    const Vec3 beside(draw(-2e-3, 2e-3), half.y() + draw(-90e-9, 90e-9), half.z() + draw(-90e-9, 90e-9));
    const Vec3 way(draw(-1, 1), draw(-1, 1), draw(-1, 1));
    const Vec3 turn = draw(0, 0.05) * test::drawnDirection(random);
    const Mat3 R_start = rotationFromVector(-turn) * R, R_end = rotationFromVector(turn) * R;
    const Vec3 own = R.transpose() * corner;
    const Pose start(R_start, beside - R_start * own - draw(5e-6, 50e-6) * way);
    const Pose end(R_end, beside - R_end * own + draw(5e-6, 50e-6) * way);
    if (deepestOverlap(a.exact, Pose(), b.exact, start).depth_m > 0) continue;
    if (!(deepestOverlap(a.exact, Pose(), b.exact, end).depth_m > 0.2e-6)) continue;
    ++overlaps;
    missed += check(a, b, start, end).empty();
  }
  EXPECT_GT(overlaps, 500);
  EXPECT_EQ(missed, 0);
}

// A block's corner starts nearer to a floor than the rest gap, rises on an arc and comes down again to a
// larger gap. No contact is missed, although the last of the segments in which the motion is examined begins
// farther from the floor.
TEST(FeatureMotion, AWayThatEndsAsNearAsItBeganMeetsNothing) {
  const Vec3 half(4e-3, 2e-3, 1e-3);
  const Body floor(box(Vec3(20e-3, 20e-3, 5e-3))), block(box(half));
  const Mat3 R_start = rotationFromVector(Vec3(0.3, -0.3, 0));
  const Mat3 R_end = rotationFromVector(0.1 * Vec3(1, 0, 1).normalized()) * R_start;
  const auto poseAt = [&](const Mat3& R, double gap_m) {
    return Pose(R, Vec3(0, 0, 5e-3 + (R * half).z() + gap_m));
  };
  const Pose start = poseAt(R_start, 1.5e-9), end = poseAt(R_end, 50e-9);
  ASSERT_GT(travel_m(floor.features, block.features, start, end), block.features.radius_m() / 20);
  EXPECT_TRUE(check(floor, block, start, end).empty());
  EXPECT_FALSE(check(floor, block, start, poseAt(R_end, -50e-9)).empty());
}

// Two rings of straight sections hang in each other where sections meet. Inside the ring such a joint is a
// valley, and the place of contact slides from one section to the next within a step, on both rings at once.
TEST(FeatureMotion, RingsThatSlideOverTheJointsOfTheirSectionsAreNotMissed) {
  constexpr double kInner_m = 9e-3, kTube_m = 3e-3;
  constexpr int kSections = 20;
  FeatureSet ring;
  ring.append(test::makeTorus(kInner_m + kTube_m, kTube_m, kSections, 10), Pose(), false);
  ring.build();
  const double slope = std::tan(std::numbers::pi / kSections);
  std::mt19937 random(5);
  const auto draw = [&](double from, double to) { return std::uniform_real_distribution(from, to)(random); };
  int missed = 0;
  for (int i = 0; i < 400; ++i) {
    // If the valleys of the rings are offset by y and z, their edges are nearer by the slope.
    const auto poseOf = [&](double gap_m, double y_m, double z_m) {
      const double apart_m = 2 * kInner_m - gap_m - slope * (std::abs(y_m) + std::abs(z_m));
      return Pose(rotationFromVector(std::numbers::pi / 2 * Vec3::UnitX()), {apart_m, y_m, z_m});
    };
    const Pose start = poseOf(draw(0.5e-6, 3e-6), draw(-5e-6, 5e-6), draw(-5e-6, 5e-6));
    const Pose end = poseOf(draw(-30e-6, -1e-6), draw(-30e-6, 30e-6), draw(-30e-6, 30e-6));
    FeatureMotion motion;
    std::vector<FeatureContact> found;
    motion.check(ring, ring, start, end, true, found);
    missed += std::none_of(found.begin(), found.end(),
                           [&](const FeatureContact& c) { return c.gap_m(end) < -0.1e-6; });
  }
  EXPECT_EQ(missed, 0);
}

// Rims of pipes of many sides cross, and slide along each other over several corners in a step with a
// rotation. On the outside of a pipe, corners are hills, and in its bore they are valleys. Edges that a
// contact holds at the end of the step dip below each other during the motion by as much as it bends.
TEST(FeatureMotion, NoRimThatSlidesOverTheCornersOfAnotherIsMissed) {
  std::mt19937 random(9);
  const auto draw = [&](double from, double to) { return std::uniform_real_distribution(from, to)(random); };
  int overlaps = 0, missed = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto pipe = [&] {
      const double r_m = draw(4e-3, 10e-3), inner_m = draw(0.4, 0.9) * r_m, high_m = draw(2e-3, 10e-3);
      const int sides = 7 + static_cast<int>(draw(0, 30));
      return Body(test::lathe({{inner_m, 0}, {r_m, 0}, {r_m, high_m}, {inner_m, high_m}}, sides));
    };
    const Body a(pipe()), b(pipe());
    struct Place {
      Vec3 at, along, outward;
    };
    const auto rim = [&](const Body& part) {  // a place on an edge
      const auto& edges = part.features.edges();
      const FeatureEdge& edge = edges[static_cast<std::size_t>(draw(0, static_cast<double>(edges.size())))];
      const Vec3 &from = part.features.vertices()[edge.from], &to = part.features.vertices()[edge.to];
      return Place{from + draw(0, 1) * (to - from), (to - from).normalized(),
                   -(edge.into[0] + edge.into[1]).normalized()};
    };
    const Place on_a = rim(a), on_b = rim(b);
    const Mat3 facing = Quat::FromTwoVectors(on_b.outward, -on_a.outward).toRotationMatrix();
    const Mat3 R = rotationFromVector(draw(0, 0.6) * test::drawnDirection(random)) *
                   rotationFromVector(draw(0, 2 * std::numbers::pi) * on_a.outward) * facing;
    // The lines of both edges keep the rest gap, wherever the edges cross.
    const auto poseAt = [&](const Mat3& turned, const Vec3& slide) {
      const Vec3 across = on_a.along.cross(turned * on_b.along).normalized();
      const Vec3 n = (across.dot(on_a.outward) < 0 ? -1 : 1) * across;
      return Pose(turned, on_a.at + slide - n.dot(slide) * n + 0.1e-6 * n - turned * on_b.at);
    };
    const Pose start = poseAt(R, Vec3::Zero());
    if (deepestOverlap(a.exact, Pose(), b.exact, start).depth_m > 0) continue;
    const Mat3 R_end = rotationFromVector(draw(0, 0.03) * test::drawnDirection(random)) * R;
    const Pose end = poseAt(R_end, draw(0, 1e-3) * test::drawnDirection(random));
    const double end_m = deepestOverlap(a.exact, Pose(), b.exact, end).depth_m;
    if (!(end_m > 0.3e-6 && end_m < 30e-6)) continue;
    ++overlaps;
    missed += check(a, b, start, end).empty();
  }
  std::printf("[ measured ] %d overlaps, %d missed\n", overlaps, missed);
  EXPECT_GT(overlaps, 20);
  EXPECT_EQ(missed, 0);
}

TEST(FeatureMotion, ListsKeptFromStepToStepChangeNoAnswer) {
  std::mt19937 random(11);
  const Body a(tetrahedron(random)), b(tetrahedron(random));
  FeatureMotion kept;
  std::vector<FeatureContact> found;
  Pose at(Mat3::Identity(), Vec3(0, 0, 30e-3));
  std::size_t reported = 0;
  for (int i = 0; i < 700; ++i) {
    const Pose next(rotationFromVector(Vec3(1e-3, 2e-3, 0)) * at.R, at.p + Vec3(0, 0, -50e-6));
    found.clear();
    kept.check(a.features, b.features, at, next, false, found);
    const auto fresh = check(a, b, at, next);
    ASSERT_EQ(found.size(), fresh.size()) << i;
    double sum_kept = 0, sum_fresh = 0;  // contacts may be in another order
    for (const FeatureContact& c : found) sum_kept = std::max(sum_kept, c.share);
    for (const FeatureContact& c : fresh) sum_fresh = std::max(sum_fresh, c.share);
    EXPECT_EQ(sum_kept, sum_fresh) << i;
    reported += found.size();
    at = next;
  }
  EXPECT_GT(reported, 0u);
}

}  // namespace
}  // namespace vps
