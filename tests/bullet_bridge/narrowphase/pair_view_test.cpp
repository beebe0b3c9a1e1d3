// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/pair/pair_view.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "support/random_draw.h"
#include "vps/mesh_distance.h"
#include "vps/pointshell.h"

namespace vps::bullet {
namespace {

std::shared_ptr<const Mesh> tubeMesh() {
  return std::make_shared<const Mesh>(makeTube(10e-3, 6e-3, 20e-3, 24));
}

ShapeModels withMesh() {
  ShapeModels models;
  models.mesh = tubeMesh();
  return models;
}

/// A body with a shape, and Bullet's wrapper of both.
struct Placed {
  explicit Placed(Shape& shape) { object.setCollisionShape(&shape); }
  btCollisionObjectWrapper at(const Pose& X_WS) {
    object.setWorldTransform(toBt(X_WS));
    return {nullptr, object.getCollisionShape(), &object, object.getWorldTransform(), -1, -1};
  }
  btCollisionObject object;
};

// Shapes whose models are rotated and shifted against their frames, at arbitrary poses.
TEST(PairView, NoPointOfTheBodiesIsNearerThanItsLeastDistance) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const Pose X_SM{test::drawnRotation(normal, random), Vec3(5e-3, -12e-3, 3e-3)};
  Shape shape0(withMesh(), X_SM), shape1(withMesh());
  const MeshDistance exact(*tubeMesh());
  const PointShell shell = buildPointShell(*tubeMesh(), {1e-3, 0.35});
  Placed body0(shape0), body1(shape1);
  // Rounding of Bullet in single precision.
  const double rounding_m = sizeof(btScalar) == 8 ? 1e-12 : 1e-7;
  int apart = 0;
  for (int i = 0; i < 300; ++i) {
    const Pose X0{test::drawnRotation(normal, random), 20e-3 * test::drawnVector(normal, random)},
        X1{test::drawnRotation(normal, random), 20e-3 * test::drawnVector(normal, random)};
    const btCollisionObjectWrapper wrapper0 = body0.at(X0), wrapper1 = body1.at(X1);
    const PairView pair(&wrapper0, &wrapper1);
    const double least_m = pair.leastDistance_m();
    double nearest_m = 1;
    for (const Vec3& p : shell.points)
      nearest_m = std::min(nearest_m, exact.closest(pair.X_01_models() * p).distance_m);
    ASSERT_LE(least_m, nearest_m + rounding_m) << i;
    apart += least_m > 0 ? 1 : 0;
  }
  EXPECT_GT(apart, 100);
  EXPECT_LT(apart, 300);
}

// A part may extend beyond its points.
TEST(PairView, WithoutMeshABodysBoxIsNotKnown) {
  ShapeModels points;
  points.shell = std::make_shared<const PointShell>(buildPointShell(*tubeMesh(), {1e-3, 0.35}));
  Shape shape0(points), shape1(withMesh());
  Placed body0(shape0), body1(shape1);
  const btCollisionObjectWrapper far = body0.at(Pose::translation({1, 0, 0})), here = body1.at({});
  EXPECT_EQ(PairView(&far, &here).leastDistance_m(), 0);
  const btCollisionObjectWrapper other = body1.at(Pose::translation({1, 0, 0}));
  Placed body2(shape1);
  const btCollisionObjectWrapper same = body2.at({});
  EXPECT_GT(PairView(&other, &same).leastDistance_m(), 0.9);
}

// A prediction that turns bodies about the world's origin looks for the spinning body 5 mm away.
TEST(PairView, ABodyThatSpinsFarFromTheOriginTurnsAboutItsCentre) {
  Shape shape(withMesh()), other(withMesh());
  btRigidBody spinning(
      btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &shape, btVector3(1e-3, 1e-3, 1e-3)));
  const Pose X_WB = Pose::translation({1, 0.5, 0});
  spinning.setWorldTransform(toBt(X_WB));
  spinning.setAngularVelocity(btVector3(0, 0, 100));
  spinning.setLinearVelocity(btVector3(2, 0, -1));
  // A child of a compound shape, whose frame is not the body's.
  const Pose X_WS = X_WB * Pose::translation({30e-3, 0, 0});
  const btTransform of_child = toBt(X_WS);
  const btCollisionObjectWrapper of_spinning{nullptr, &shape, &spinning, of_child, -1, -1};
  Placed standing(other);
  const btCollisionObjectWrapper of_standing = standing.at({});
  const PairView start(&of_spinning, &of_standing);
  PairView later = start;
  const double dt_s = 1e-3;
  advance(later, start, dt_s, dt_s);
  const double rounding = sizeof(btScalar) == 8 ? 1e-12 : 1e-6;
  const Mat3 R = rotationFromVector(Vec3(0, 0, 100 * dt_s));
  EXPECT_LT((later.X_WS[0].p - (X_WB.p + dt_s * Vec3(2, 0, -1) + R * Vec3(30e-3, 0, 0))).norm(), rounding);
  EXPECT_LT((later.X_WS[0].R - R).norm(), rounding);
  EXPECT_LT((later.X_WS[1].p).norm(), rounding);
}

}  // namespace
}  // namespace vps::bullet
