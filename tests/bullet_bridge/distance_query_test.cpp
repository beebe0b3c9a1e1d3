// SPDX-License-Identifier: BSD-3-Clause
// Queries answer at the distance that is asked for, also beyond the band of the fields.
#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_bridge/world.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::World;

const Built& cube() {
  static const Built built = test::build(makeBox(Vec3::Constant(0.01)), 7850, 0.5e-3, 1e-3);  // band 2 mm
  return built;
}

struct Nearest : btCollisionWorld::ContactResultCallback {
  double distance_m = 1e30;
  explicit Nearest(double threshold_m) { m_closestDistanceThreshold = toBt(threshold_m); }
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    distance_m = std::min<double>(distance_m, point.m_distance1);
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
      Nearest near(2 * gap_m), reverse(2 * gap_m), out_of_reach(0.5 * gap_m);
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
      Nearest near(1.5 * gap_m);
      world.world->contactPairTest(&low, &high, near);
      // The lowest vertex need not be a point of the shell: half a spacing aside, s^2 / (8 r) = 13 um.
      EXPECT_NEAR(near.distance_m, gap_m, 13e-6 + 1e-6) << under->getName() << ' ' << gap_m;
    }
  }
}

}  // namespace
}  // namespace vps::bullet
