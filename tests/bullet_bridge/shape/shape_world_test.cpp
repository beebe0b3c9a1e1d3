// SPDX-License-Identifier: BSD-3-Clause
// A Shape in Bullet's world: rays, sweeps, debug drawing, ghost objects, sleeping, removal.
#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bullet_bridge/world.h"
#include "vps_bullet/shape.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::World;

TEST(ShapeInWorld, ARayHitsItWhereItIs) {
  World world;
  ShapeModels models;
  models.mesh = std::make_shared<const Mesh>(makeTube(0.01, 0.005, 0.02, 64));
  Shape shape(models);
  world.addShape(shape, 0, Vec3::Zero(), Pose::translation(Vec3(0, 0, 0.1)));
  const auto cast = [&](const Vec3& from, const Vec3& to) {
    btCollisionWorld::ClosestRayResultCallback hit(toBt(from), toBt(to));
    world.world->rayTest(toBt(from), toBt(to), hit);
    return hit.hasHit() ? fromBt(hit.m_hitPointWorld) : Vec3(9, 9, 9);
  };
  EXPECT_LE((cast(Vec3(0.0075, 0, 1), Vec3(0.0075, 0, -1)) - Vec3(0.0075, 0, 0.11)).norm(), 1e-6);
  EXPECT_EQ(cast(Vec3(0, 0, 1), Vec3(0, 0, -1)).x(), 9) << "through the hole";
}

TEST(ShapeInWorld, AConvexSweepStopsAtIt) {
  World world;
  ShapeModels models;
  models.mesh = std::make_shared<const Mesh>(makeTube(0.01, 0.005, 0.02, 64));
  Shape shape(models);
  world.addShape(shape, 0, Vec3::Zero(), Pose());
  btSphereShape ball(toBt(0.003));  // in single precision Bullet's own cast misses a ball of 1 mm
  const auto sweep = [&](double x_m) {
    const btVector3 from(toBt(x_m), 0, toBt(0.113)), to(toBt(x_m), 0, toBt(-0.087));
    btCollisionWorld::ClosestConvexResultCallback hit(from, to);
    world.world->convexSweepTest(&ball, btTransform(btQuaternion::getIdentity(), from),
                                 btTransform(btQuaternion::getIdentity(), to), hit);
    return hit.hasHit() ? static_cast<double>(hit.m_closestHitFraction) : 2.0;
  };
  // The centre is 3 mm above the top at 10 mm: after half of the path of 0.2 m. Bullet's cast stops within
  // 1e-4 of contact.
  EXPECT_NEAR(sweep(0.0075), 0.5, 2e-3);
  EXPECT_EQ(sweep(0), 2) << "through the hole";
}

TEST(ShapeInWorld, IsDrawnByItsTriangles) {
  struct Lines : btIDebugDraw {
    int count = 0;
    btVector3 low{1, 1, 1}, high{-1, -1, -1};
    void drawLine(const btVector3& a, const btVector3& b, const btVector3&) override {
      ++count;
      for (const btVector3& p : {a, b}) low.setMin(p), high.setMax(p);
    }
    void drawContactPoint(const btVector3&, const btVector3&, btScalar, int, const btVector3&) override {}
    void reportErrorWarning(const char*) override {}
    void draw3dText(const btVector3&, const char*) override {}
    void setDebugMode(int) override {}
    int getDebugMode() const override { return DBG_DrawWireframe; }
  } lines;
  World world;
  world.world->setDebugDrawer(&lines);
  const Shape shape(test::boxMesh());
  world.world->debugDrawObject(toBt(Pose::translation(Vec3(0.1, 0, 0))), &shape, btVector3(1, 1, 1));
  EXPECT_GE(lines.count, 12 * 3);
  // Includes the axes that Bullet draws at the origin, 0.1 m long.
  EXPECT_NEAR(lines.low.x(), 0.09, 1e-6);
  EXPECT_NEAR(lines.low.y(), -0.02, 1e-6);
  EXPECT_NEAR(lines.low.z(), -0.03, 1e-6);
}

Built steel() {
  return test::build(makeBox(Vec3::Constant(0.01)), 7850, 0.5e-3, 1e-3);
}

TEST(ShapeInWorld, AGhostObjectDetectsItWithoutForce) {
  const Built box = steel();
  World world;
  btGhostPairCallback callback;
  world.broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(&callback);
  btPairCachingGhostObject ghost;
  ghost.setCollisionShape(box.shape.get());
  ghost.setCollisionFlags(btCollisionObject::CF_NO_CONTACT_RESPONSE);
  world.world->addCollisionObject(&ghost, btBroadphaseProxy::SensorTrigger);
  btRigidBody& body = world.add(box, Pose::translation(Vec3(0.004, 0.003, 0.012)));
  int steps_seen = 0, steps_touched = 0;
  for (int i = 0; i < 150; ++i) {
    world.step();
    if (ghost.getNumOverlappingObjects() == 1 && ghost.getOverlappingObject(0) == &body) ++steps_seen;
    // Reads the ghost object's contacts as Bullet's manual describes.
    btManifoldArray manifolds;
    world.dispatcher.dispatchAllCollisionPairs(ghost.getOverlappingPairCache(),
                                               world.world->getDispatchInfo(), &world.dispatcher);
    btBroadphasePairArray& pairs = ghost.getOverlappingPairCache()->getOverlappingPairArray();
    for (int p = 0; p < pairs.size(); ++p)
      if (pairs[p].m_algorithm) pairs[p].m_algorithm->getAllContactManifolds(manifolds);
    for (int m = 0; m < manifolds.size(); ++m)
      if (manifolds[m]->getNumContacts() > 0) {
        ++steps_touched;
        break;
      }
  }
  // The body falls freely through 20 mm of overlap, from 2 mm above: from 20 ms to 67 ms.
  EXPECT_GT(steps_seen, 40);
  EXPECT_GE(steps_touched, 46);
  EXPECT_LE(steps_touched, 50);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.012 - 9.81e-6 * 150 * 151 / 2, 1e-6);
  world.world->removeCollisionObject(&ghost);
}

TEST(ShapeInWorld, FallsAsleepAtRestAndWakesWhenItIsHit) {
  const Built box = steel();
  World world;
  world.add(box, Pose(), true);
  btRigidBody& lower = world.add(box, Pose::translation(Vec3(0, 0, 0.010)));
  btRigidBody& upper = world.add(box, Pose::translation(Vec3(0.003, 0, 0.030)));
  upper.setGravity(btVector3(0, 0, 0));
  for (btRigidBody* body : {&lower, &upper}) {
    body->forceActivationState(ACTIVE_TAG);
    tuneBody(*body);
  }
  world.step(2500);  // Bullet waits for two seconds of rest
  EXPECT_EQ(lower.getActivationState(), ISLAND_SLEEPING);
  EXPECT_EQ(upper.getActivationState(), ISLAND_SLEEPING);
  upper.activate();
  upper.setLinearVelocity(btVector3(0, 0, toBt(-0.5)));
  world.step(40);
  EXPECT_NE(lower.getActivationState(), ISLAND_SLEEPING);
  EXPECT_GE(upper.getWorldTransform().getOrigin().z(), 0.020 - 5e-6);
}

TEST(ShapeInWorld, ABodyCanBeRemovedWhileOthersTouchIt) {
  const Built box = steel();
  World world;
  world.add(box, Pose(), true);
  btRigidBody& middle = world.add(box, Pose::translation(Vec3(0, 0, 0.010)));
  btRigidBody& top = world.add(box, Pose::translation(Vec3(0, 0, 0.020)));
  world.step(100);
  world.world->removeRigidBody(&middle);
  world.step(100);
  EXPECT_NEAR(top.getWorldTransform().getOrigin().z(), 0.010, 1e-6);
  world.world->addRigidBody(&middle);  // at the present place of `top`
  world.step(5);
  EXPECT_TRUE(fromBt(middle.getWorldTransform()).isFinite());
}

TEST(ShapeInWorld, OutlivesItsDispatcherAndWorksWithTheNext) {
  const Built box = steel();
  for (int life = 0; life < 2; ++life) {
    World world;
    world.add(box, Pose(), true);
    btRigidBody& body = world.add(box, Pose::translation(Vec3(0, 0, 0.010)));  // one shape, two bodies
    world.step(50);
    EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.010, 1e-6);
  }
}

TEST(ShapeInWorld, ABodyWhosePoseIsNotFiniteHasNoContact) {
  const Built box = steel();
  World world;
  btRigidBody& fixed = world.add(box, Pose(), true);
  btRigidBody& body = world.add(box, Pose::translation(Vec3(0, 0, 0.0099)));
  world.step();
  ASSERT_GT(world.dispatcher.getNumManifolds(), 0);
  btTransform lost = body.getWorldTransform();
  lost.setOrigin(btVector3(std::numeric_limits<btScalar>::quiet_NaN(), 0, 0));
  body.setWorldTransform(lost);
  btBroadphasePairArray& pairs = world.broadphase.getOverlappingPairCache()->getOverlappingPairArray();
  ASSERT_EQ(pairs.size(), 1);
  world.dispatcher.getNearCallback()(pairs[0], world.dispatcher, world.world->getDispatchInfo());
  for (int m = 0; m < world.dispatcher.getNumManifolds(); ++m)
    EXPECT_EQ(world.dispatcher.getManifoldByIndexInternal(m)->getNumContacts(), 0);
  struct : btCollisionWorld::ContactResultCallback {
    int count = 0;
    btScalar addSingleResult(btManifoldPoint&, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) override {
      return toBt(++count);
    }
  } found;
  world.world->contactPairTest(&body, &fixed, found);
  EXPECT_EQ(found.count, 0);
}

}  // namespace
}  // namespace vps::bullet
