// SPDX-License-Identifier: BSD-3-Clause
// Queries report points up to the requested distance, also beyond the band of the fields.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "bullet_bridge/world.h"
#include "support/random_draw.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::cube;
using test::World;

struct NearestPoint : btCollisionWorld::ContactResultCallback {
  double distance_m = 1e30;
  Vec3 n = Vec3::Zero();
  explicit NearestPoint(double threshold_m) { m_closestDistanceThreshold = toBt(threshold_m); }
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    if (point.m_distance1 < distance_m) {
      distance_m = point.m_distance1;
      n = fromBt(point.m_normalWorldOnB);
    }
    return 0;
  }
};

TEST(DistanceQuery, AnswersBeyondTheBandForEveryKindOfPartner) {
  btBoxShape box(btVector3(toBt(0.005), toBt(0.005), toBt(0.005)));
  btSphereShape ball(toBt(0.005));
  btTriangleMesh triangles;
  for (const auto& t : cube().mesh.triangles)
    triangles.addTriangle(toBt(cube().mesh.vertices[t[0]]), toBt(cube().mesh.vertices[t[1]]),
                          toBt(cube().mesh.vertices[t[2]]));
  btBvhTriangleMeshShape mesh(&triangles, true);
  for (const double gap_m : {0.2e-3, 1.5e-3, 1.95e-3, 5e-3, 30e-3}) {
    for (btCollisionShape* under :
         std::initializer_list<btCollisionShape*>{cube().shape.get(), &box, &ball, &mesh}) {
      World world;
      btRigidBody& low = world.addShape(*under, 0, Vec3::Zero(), Pose());
      btRigidBody& high = world.add(cube(), Pose::translation(Vec3(0, 0, 0.01 + gap_m)));
      NearestPoint near(2 * gap_m), reverse(2 * gap_m), out_of_reach(0.5 * gap_m);
      world.world->contactPairTest(&low, &high, near);
      world.world->contactPairTest(&high, &low, reverse);
      world.world->contactPairTest(&low, &high, out_of_reach);
      // Faces are exact; over a ball the nearest point may be half a spacing aside: s^2 / (8 r) = 25 um.
      const double error_m = under == &ball ? 25e-6 : 1e-6;
      EXPECT_NEAR(near.distance_m, gap_m, error_m) << under->getName() << ' ' << gap_m;
      EXPECT_NEAR(reverse.distance_m, gap_m, error_m) << under->getName() << ' ' << gap_m;
      EXPECT_EQ(out_of_reach.distance_m, 1e30) << under->getName() << ' ' << gap_m;
    }
  }
}

// The nearest point of a ball faces the other part, and all its other points lean away from it.
TEST(DistanceQuery, OfABallIsNotThatOfItsPlanesThatLeanAway) {
  const double radius_m = 0.01;
  const Built ball = test::build(makeSphere(radius_m, 4), 7850, 0.5e-3, 1e-3);
  double lowest_m = 0;  // of the mesh, whose facets lie within the sphere
  for (const Vec3& p : ball.mesh.vertices) lowest_m = std::min(lowest_m, p.z());
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  btBoxShape box(btVector3(toBt(0.05), toBt(0.05), toBt(0.005)));
  for (const double gap_m : {1e-3, 10e-3, 50e-3, 500e-3}) {
    for (btCollisionShape* under : std::initializer_list<btCollisionShape*>{&plane, &box}) {
      World world;
      btRigidBody& low =
          world.addShape(*under, 0, Vec3::Zero(), Pose::translation(Vec3(0, 0, under == &box ? -0.005 : 0)));
      btRigidBody& high = world.add(ball, Pose::translation(Vec3(0, 0, gap_m - lowest_m)));
      NearestPoint near(1.5 * gap_m);
      world.world->contactPairTest(&low, &high, near);
      // The lowest vertex need not be a point of the shell: half a spacing aside, s^2 / (8 r) = 13 um.
      EXPECT_NEAR(near.distance_m, gap_m, 13e-6 + 1e-6) << under->getName() << ' ' << gap_m;
    }
  }
}

/// Width of the slab with this normal between two sets of points.
double gapAlong(const Vec3& n, const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  const auto range = [&](const std::vector<Vec3>& points) {
    double low_m = 1e30, high_m = -1e30;
    for (const Vec3& p : points) {
      low_m = std::min(low_m, n.dot(p));
      high_m = std::max(high_m, n.dot(p));
    }
    return std::array{low_m, high_m};
  };
  const auto of_a = range(a), of_b = range(b);
  return std::max(of_a[0] - of_b[1], of_b[0] - of_a[1]);
}

// The thickness of a slab that separates two convex bodies is a lower bound of their distance. A reported
// distance that equals the thickness of the slab along the reported normal is therefore the smallest one. The
// bodies lean in all directions: the nearest place is at corners, edges and faces in turn, and mostly between
// the points of the shell.
TEST(DistanceQuery, IsTheLeastBetweenConvexBodies) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto direction = [&] { return test::drawnVector(normal, random).normalized(); };
  btConvexHullShape hull;
  std::vector<Vec3> corners;
  for (int i = 0; i < 200; ++i) {
    corners.push_back(0.02 * direction());
    hull.addPoint(toBt(corners.back()));
  }
  hull.setMargin(0);
  for (int i = 0; i < 40; ++i) {
    const Pose X_WH(rotationFromVector(direction()), 0.055 * direction());
    World world;
    btRigidBody& far = world.addShape(hull, 0, Vec3::Zero(), X_WH);
    btRigidBody& part = world.add(cube(), Pose());
    NearestPoint near(0.1);
    world.world->contactPairTest(&far, &part, near);
    std::vector<Vec3> placed;
    for (const Vec3& p : corners) placed.push_back(X_WH * p);
    // The last iteration gains less than 0.1 nm; positions in single precision round to 4 nm.
    EXPECT_NEAR(near.distance_m, gapAlong(near.n, placed, cube().mesh.vertices), 1e-6) << i;
  }
}

}  // namespace
}  // namespace vps::bullet
