// SPDX-License-Identifier: BSD-3-Clause
#include "vps/mesh_overlap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/analytic.h"
#include "vps/solid.h"

namespace vps {
namespace {

OverlapMesh overlapMesh(const Mesh& mesh) {
  return OverlapMesh(std::make_shared<const Solid>(mesh));
}
OverlapMesh box(double x, double y, double z) {
  return overlapMesh(makeBox(Vec3(x, y, z)));
}

TEST(MeshOverlap, ACornerInAFaceHasItsDepth) {
  const OverlapMesh floor = box(1, 1, 0.2), block = box(0.1, 0.1, 0.1);
  // The cube's corner that points straight down is sqrt(3) / 2 of its side below the centre.
  const Mat3 R = Quat::FromTwoVectors(Vec3(-1, -1, -1), Vec3(0, 0, -1)).toRotationMatrix();
  const double below_m = 0.05 * std::sqrt(3.0);
  for (const double depth_m : {1e-9, 1e-6, 1e-3, 0.02}) {
    const Pose X(R, Vec3(0.03, -0.02, 0.1 + below_m - depth_m));
    const Overlap found = deepestOverlap(floor, Pose(), block, X);
    // A corner is an end of an edge, which the search approaches by halving.
    EXPECT_NEAR(found.depth_m, depth_m, kOverlapCertain_m + 1e-12);
    if (found.depth_m > 0) {
      EXPECT_NEAR(found.p_W.z(), 0.1 - depth_m, kOverlapCertain_m + 1e-12);
    }
    EXPECT_NEAR(deepestOverlap(block, X, floor, Pose()).depth_m, depth_m, kOverlapCertain_m + 1e-12);
  }
}

TEST(MeshOverlap, CrossedBarsWithoutAVertexInsideHaveTheirDepth) {
  const OverlapMesh bar = box(1, 0.1, 0.1);
  const Mat3 R = rotationFromVector(Vec3(0, 0, M_PI / 2));
  for (const double depth_m : {1e-6, 1e-3, 0.01})
    EXPECT_NEAR(deepestOverlap(bar, Pose(), bar, Pose(R, Vec3(0.2, 0.1, 0.1 - depth_m))).depth_m, depth_m,
                kOverlapCertain_m);
}

// Two wedges of 90 degrees whose edges cross: the depth of a point of an edge, its distance from both faces
// of the other wedge, is 1 / sqrt(2) of its height below the other edge.
TEST(MeshOverlap, AnEdgeAcrossAnEdgeHasItsDistanceToTheFaces) {
  const OverlapMesh bar = box(1, 0.1, 0.1);
  const Mat3 up = rotationFromVector(Vec3(M_PI / 4, 0, 0));
  const Mat3 across = rotationFromVector(Vec3(0, 0, M_PI / 2)) * up;
  const double half_m = 0.1 / std::sqrt(2.0);
  for (const double depth_m : {1e-5, 1e-3}) {
    const Pose X(across, Vec3(0, 0, 2 * half_m - depth_m));
    EXPECT_NEAR(deepestOverlap(bar, Pose(up, Vec3::Zero()), bar, X).depth_m, depth_m / std::sqrt(2.0),
                kOverlapCertain_m);
  }
}

TEST(MeshOverlap, ABoxWithinABoxHasTheDepthOfItsFarthestEdge) {
  const OverlapMesh outer = box(1, 1, 1), inner = box(0.2, 0.2, 0.2);
  // Edges of the inner box, 0.1 from its centre in two directions, are at most 0.4 below the outer faces.
  EXPECT_NEAR(deepestOverlap(outer, Pose(), inner, Pose()).depth_m, 0.4, kOverlapCertain_m);
  EXPECT_NEAR(deepestOverlap(inner, Pose(), outer, Pose()).depth_m, 0.4, kOverlapCertain_m);
}

TEST(MeshOverlap, WhatIsApartOrTouchesDoesNotOverlap) {
  const OverlapMesh block = box(0.1, 0.1, 0.1), tube = overlapMesh(makeTube(0.5, 0.4, 0.2, 64));
  EXPECT_EQ(deepestOverlap(block, Pose(), block, Pose::translation(Vec3(0.1001, 0, 0))).depth_m, 0);
  EXPECT_LE(deepestOverlap(block, Pose(), block, Pose::translation(Vec3(0.1, 0.03, 0))).depth_m, 1e-16);
  // The block lies in the tube's bore, at the place where their boxes overlap.
  EXPECT_EQ(deepestOverlap(tube, Pose(), block, Pose()).depth_m, 0);
}

// A resting part lies on long edges, which must not take longer to judge than short edges.
TEST(MeshOverlap, AFlatContactNeedsFewPieces) {
  const OverlapMesh floor = box(1, 1, 0.2), block = box(0.3, 0.2, 0.1);
  const Pose X = Pose::translation(Vec3(0, 0, 0.15 - 2e-9));
  const Overlap found = deepestOverlap(floor, Pose(), block, X);
  EXPECT_LE(found.depth_m, 2e-9 + 1e-16);
}

double sampledOnFacets_m(const OverlapMesh& in, const OverlapMesh& of, const Pose& X) {
  double sampled_m = 0;
  constexpr int kSteps = 60;
  for (const auto& t : of.mesh().triangles)
    for (int i = 0; i <= kSteps; ++i)
      for (int k = 0; i + k <= kSteps; ++k) {
        const auto& v = of.mesh().vertices;
        const Vec3 p =
            v[t[0]] + double(i) / kSteps * (v[t[1]] - v[t[0]]) + double(k) / kSteps * (v[t[2]] - v[t[0]]);
        sampled_m = std::max(sampled_m, -in.solid().signedDistance(X * p));
      }
  return sampled_m;
}

// Samples 51 points on each edge of both meshes. No sample may be deeper in the other mesh than the depth
// that deepestOverlap() returns. The returned depth exceeds that of the samples by at most half of their
// spacing, except if the deepest place is in the interior of a face; then the faces are sampled too.
TEST(MeshOverlap, NoPointOfAnEdgeIsDeeper) {
  test::RandomPoints random(5);
  const OverlapMesh a = box(0.2, 0.15, 0.1), b = overlapMesh(makeTube(0.1, 0.06, 0.15, 8));
  int overlapping = 0, deeper_on_facets = 0;
  for (int i = 0; i < 200; ++i) {
    const Pose X_AB = random.pose(0.15);
    const double depth_m = deepestOverlap(a, Pose(), b, X_AB).depth_m;
    double sampled_m = 0;
    const auto sample = [&](const OverlapMesh& in, const OverlapMesh& of, const Pose& X) {
      for (const auto& [from, to] : of.edges())
        for (int k = 0; k <= 50; ++k) {
          const Vec3& p = of.mesh().vertices[from];
          const Vec3 q = X * (p + k / 50.0 * (of.mesh().vertices[to] - p));
          sampled_m = std::max(sampled_m, -in.solid().signedDistance(q));
        }
    };
    sample(a, b, X_AB);
    sample(b, a, X_AB.inverse());
    overlapping += sampled_m > 0;
    EXPECT_GE(depth_m, sampled_m - kOverlapCertain_m) << i;
    if (depth_m > 0 && sampled_m < depth_m - 0.004) {
      sampled_m = std::max(sampledOnFacets_m(a, b, X_AB), sampledOnFacets_m(b, a, X_AB.inverse()));
      ++deeper_on_facets;
    }
    // Half the spacing of the samples.
    EXPECT_TRUE(depth_m == 0 || sampled_m >= depth_m - 0.004) << i << ": " << depth_m << ", " << sampled_m;
  }
  EXPECT_GT(overlapping, 50);
  EXPECT_LT(deeper_on_facets, overlapping / 10);
}

// Two equal boxes, moved along one axis: their sides stay flush, so all edges lie in the other box's surface.
TEST(MeshOverlap, FlushBoxesHaveTheDepthOfTheFaceBetweenThem) {
  const OverlapMesh cube = box(0.01, 0.01, 0.01);
  const Mat3 turned = rotationFromVector(Vec3(0.3, -0.5, 0.2));
  for (const double depth_m : {1e-6, 20e-6, 1e-3, 3e-3, 5e-3})
    for (int axis = 0; axis < 3; ++axis)
      for (const Mat3& R : {Mat3(Mat3::Identity()), turned}) {
        const Pose X_WA(R, Vec3(0.1, 0.2, 0)), X_AB = Pose::translation((0.01 - depth_m) * Vec3::Unit(axis));
        for (const double found_m : {deepestOverlap(cube, X_WA, cube, X_WA * X_AB).depth_m,
                                     deepestOverlap(cube, X_WA * X_AB, cube, X_WA).depth_m}) {
          EXPECT_LE(found_m, depth_m + 1e-12) << axis;
          EXPECT_GE(found_m, depth_m * 0.9 - 1e-12) << axis;  // 80 probes for a facet find 0.93 at least
        }
      }
}

// A point inside both bodies is at most 5 mm deep; the probes find a point at least half as deep.
TEST(MeshOverlap, EqualBodiesInOnePlaceOverlap) {
  const OverlapMesh cube = box(0.01, 0.01, 0.01), tube = overlapMesh(makeTube(0.02, 0.01, 0.03, 32));
  const Mat3 quarter = rotationFromVector(Vec3(0, 0, M_PI / 2));
  for (const Pose& X : {Pose(), Pose(quarter, Vec3::Zero())}) {
    const double found_m = deepestOverlap(cube, Pose(), cube, X).depth_m;
    EXPECT_GE(found_m, 2.5e-3);
    EXPECT_LE(found_m, 5e-3 + 1e-12);
  }
  // The tube's walls are 10 mm thick.
  const double in_tube_m = deepestOverlap(tube, Pose(), tube, Pose()).depth_m;
  EXPECT_GE(in_tube_m, 2.5e-3);
  EXPECT_LE(in_tube_m, 5e-3 + 1e-12);
}

TEST(MeshOverlap, ABoxFlushInALargerOneOverlaps) {
  const OverlapMesh large = box(0.01, 0.01, 0.01), small = box(4e-3, 4e-3, 4e-3), bar = box(0.03, 0.01, 0.01);
  // In a corner: the inner corner of the small box is 4 mm below three faces.
  EXPECT_NEAR(deepestOverlap(large, Pose(), small, Pose::translation(Vec3::Constant(3e-3))).depth_m, 4e-3,
              kOverlapCertain_m);
  // Between four sides of the bar, in its middle: the ends of the cube are 5 mm below all four sides.
  const double in_bar_m = deepestOverlap(bar, Pose(), large, Pose()).depth_m;
  EXPECT_GE(in_bar_m, 5e-3 * 0.9);
  EXPECT_LE(in_bar_m, 5e-3 + 1e-12);
  // Crossed bars, flush above and below: each bar's sides are 5 mm below the other's.
  const Mat3 across = rotationFromVector(Vec3(0, 0, M_PI / 2));
  for (const double along_m : {0.0, 0.008}) {
    const double crossed_m = deepestOverlap(bar, Pose(), bar, Pose(across, Vec3(along_m, 0, 0))).depth_m;
    EXPECT_GE(crossed_m, 5e-3 * 0.9) << along_m;
    EXPECT_LE(crossed_m, 5e-3 + 1e-12) << along_m;
  }
}

TEST(MeshOverlap, EqualCylindersOnOneAxisHaveTheDepthOfTheirEnds) {
  const OverlapMesh cylinder = overlapMesh(makeCylinder(0.005, 0.02, 48));
  for (const double depth_m : {20e-6, 1e-3}) {
    const double found_m =
        deepestOverlap(cylinder, Pose(), cylinder, Pose::translation(Vec3(0, 0, 0.02 - depth_m))).depth_m;
    EXPECT_LE(found_m, depth_m + 1e-12);
    EXPECT_GE(found_m, depth_m * 0.9);
  }
}

// The depth of edges is continuous. Flush faces that are misaligned by less than the accuracy of edges must
// give the same depth.
TEST(MeshOverlap, NearlyFlushBoxesHaveTheDepthOfTheFaceBetweenThem) {
  const OverlapMesh cube = box(0.01, 0.01, 0.01);
  for (const double off_m : {1e-15, 1e-12, 1e-9, -1e-9, 1e-7, 1e-6}) {
    const Pose X(rotationFromVector(Vec3(0, 0, off_m)), Vec3(7e-3, off_m, 0.5 * off_m));
    const double found_m = deepestOverlap(cube, Pose(), cube, X).depth_m;
    EXPECT_LE(found_m, 3e-3 + 1e-8) << off_m;
    EXPECT_GE(found_m, 3e-3 * 0.9) << off_m;
  }
}

TEST(MeshOverlap, FacesInContactDoNotOverlap) {
  const OverlapMesh cube = box(0.01, 0.01, 0.01), plate = box(0.1, 0.1, 0.002);
  const OverlapMesh cylinder = overlapMesh(makeCylinder(0.005, 0.02, 48));
  const OverlapMesh tube = overlapMesh(makeTube(0.02, 0.005, 0.02, 48));
  for (const Vec3& p : {Vec3(0.01, 0, 0), Vec3(0.01, 0.003, 0), Vec3(0.01, 0.003, -0.004),
                        Vec3(0, 0.01, 0.01), Vec3(0, 0, -0.01)})
    EXPECT_LE(deepestOverlap(cube, Pose(), cube, Pose::translation(p)).depth_m, 1e-16);
  EXPECT_LE(deepestOverlap(plate, Pose(), cube, Pose::translation(Vec3(0.01, 0.02, 0.006))).depth_m, 1e-16);
  // A bar that is flush with two sides of the plate too.
  EXPECT_LE(deepestOverlap(plate, Pose(), cube, Pose::translation(Vec3(0.045, 0.045, 0.006))).depth_m, 1e-16);
  EXPECT_LE(deepestOverlap(cylinder, Pose(), cylinder, Pose::translation(Vec3(0, 0, 0.02))).depth_m, 1e-16);
  // A pin that fills a bore exactly.
  EXPECT_LE(deepestOverlap(tube, Pose(), cylinder, Pose()).depth_m, 1e-16);
}

}  // namespace
}  // namespace vps
