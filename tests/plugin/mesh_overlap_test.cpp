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
  // The corner of a cube that points straight down is sqrt(3) / 2 of its side below the centre.
  const Mat3 R = Quat::FromTwoVectors(Vec3(-1, -1, -1), Vec3(0, 0, -1)).toRotationMatrix();
  const double below_m = 0.05 * std::sqrt(3.0);
  for (const double depth_m : {1e-9, 1e-6, 1e-3, 0.02}) {
    const Pose X(R, Vec3(0.03, -0.02, 0.1 + below_m - depth_m));
    const Overlap found = deepestOverlap(floor, Pose(), block, X);
    // A corner is an end of an edge, which the search approaches by halves.
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

// Two wedges of 90 degrees, edges across each other: each point of an edge is 1 / sqrt(2) of its depth below
// the other edge away from both faces there.
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
  // In the bore, where the boxes overlap.
  EXPECT_EQ(deepestOverlap(tube, Pose(), block, Pose()).depth_m, 0);
}

// A resting part lies on long edges, which must not take longer to judge than short ones.
TEST(MeshOverlap, AFlatContactNeedsFewPieces) {
  const OverlapMesh floor = box(1, 1, 0.2), block = box(0.3, 0.2, 0.1);
  const Pose X = Pose::translation(Vec3(0, 0, 0.15 - 2e-9));
  const Overlap found = deepestOverlap(floor, Pose(), block, X);
  EXPECT_LE(found.depth_m, 2e-9 + 1e-16);
}

// Points of both surfaces, far more of them than edges need: none may be deeper in the other mesh, but for
// the interior of faces, where the other's edges stand for them.
TEST(MeshOverlap, NoPointOfAnEdgeIsDeeper) {
  test::RandomPoints random(5);
  const OverlapMesh a = box(0.2, 0.15, 0.1), b = overlapMesh(makeTube(0.1, 0.06, 0.15, 8));
  int overlapping = 0;
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
    // Half the spacing of the samples.
    EXPECT_TRUE(depth_m == 0 || sampled_m >= depth_m - 0.004) << i << ": " << depth_m << ", " << sampled_m;
  }
  EXPECT_GT(overlapping, 50);
}

}  // namespace
}  // namespace vps
