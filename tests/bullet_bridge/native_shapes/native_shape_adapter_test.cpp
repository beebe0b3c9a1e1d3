// SPDX-License-Identifier: BSD-3-Clause
#include "native_shapes/native_shape_adapter.h"

#include <BulletCollision/CollisionShapes/btConvex2dShape.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "bullet_bridge/native_shapes.h"
#include "native_shapes/native_shape.h"

namespace vps::bullet {
namespace {

using test::at;
using test::cube;
using test::floorMesh;
using test::Ground;
using test::kIsDouble;
using test::slabCorners;
using test::slabHull;
using test::slabMesh;
using test::SolverKind;
using test::UserConcave;
using test::World;

TEST(NativeShapes, ADynamicHullRestsOnAVpsPart) {
  btConvexHullShape hull;
  for (const btVector3& p : slabCorners(0.004, -0.004, 0.004)) hull.addPoint(p);
  World world;
  world.add(cube(), Pose(), true);
  btVector3 inertia;
  hull.setMargin(0);
  hull.calculateLocalInertia(toBt(0.004), inertia);
  btRigidBody& body = world.addShape(hull, 0.004, fromBt(inertia), Pose::translation(Vec3(0, 0, 0.0092)));
  world.step(500);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.009, 1e-6);
  EXPECT_LE(body.getAngularVelocity().length(), kIsDouble ? 1e-4 : 2e-3);
}

TEST(NativeShapes, ContactFollowsAShapeThatIsResized) {
  World world;
  btConvexHullShape hull;
  for (const btVector3& p : slabCorners(0.03, -0.004, 0.004)) hull.addPoint(p);
  btRigidBody& low = world.addShape(hull, 0, Vec3::Zero(), Pose());
  btRigidBody& body = world.add(cube(), Pose::translation(Vec3(0, 0, 0.0092)));
  world.step(200);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.009, 1e-6);
  hull.setLocalScaling(at(1, 1, 0.5));
  world.world->updateSingleAabb(&low);
  world.step(200);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.007, 1e-6);
}

// Poses of seven cubes after falling on four kinds of shapes for a tenth of a second. With 0 threads the
// stock dispatcher is used.
std::vector<btTransform> fallOnNativeShapes(int threads) {
  Ground ground;
  btBoxShape box(at(0.02, 0.02, 0.01));
  btSphereShape ball(toBt(0.02));
  btCollisionShape* shapes[] = {&slabHull(ground, 0.5), &box,
                                &ground.keep<btBvhTriangleMeshShape>(&floorMesh(ground), true), &ball};
  World world(SolverKind::Constraint, {}, 100, {}, threads);
  for (int i = 0; i < 4; ++i)
    world.addShape(*shapes[i], 0, Vec3::Zero(), Pose::translation(Vec3(0.015 * i, 0.01 * (i % 2), -0.012)));
  for (int i = 0; i < 7; ++i)
    world.addShape(*cube().shape, cube().frame.mass_kg, cube().frame.inertia_kg_m2,
                   Pose(rotationFromVector(Vec3(0.3 * i, 0.2, 0.1 * i)),
                        Vec3(0.012 * (i % 4), 0, 0.01 + 0.012 * (i / 4))));
  return test::placesAfter(world, 100);
}

TEST(NativeShapes, GiveTheSameBitsWithSeveralThreads) {
  const std::vector<btTransform> expected = fallOnNativeShapes(0);
  for (const int threads : {1, 3}) {
    const std::vector<btTransform> got = fallOnNativeShapes(threads);
    for (std::size_t i = 0; i < expected.size(); ++i)
      ASSERT_TRUE(got[i] == expected[i]) << threads << ", body " << i;
  }
}

TEST(NativeShapeCache, SharesOneAdapterAndDetectsAnotherShapeAtTheSameAddress) {
  NativeShapeCache cache;
  alignas(16) std::array<unsigned char, sizeof(btConvexHullShape)> room;
  const auto slab = [](double low_m) {
    // Bounding boxes are equal: only the corners differ.
    std::vector<btVector3> corners = slabCorners(0.01, -0.01, 0.01);
    corners[0] = at(-0.01, -0.01, low_m);
    return corners;
  };
  const auto place = [&](double low_m) {
    auto* hull = new (room.data()) btConvexHullShape();
    for (const btVector3& p : slab(low_m)) hull->addPoint(p);
    return hull;
  };
  btConvexHullShape* hull = place(-0.01);
  const NativeShapeAdapter* first = cache.get(*hull).get();
  EXPECT_EQ(cache.get(*hull).get(), first);
  hull->~btConvexHullShape();
  hull = place(-0.009);
  const auto corner_of_first = Vec3(-0.01, -0.01, -0.01);
  EXPECT_GT(cache.get(*hull)->models().surfaces[0].distance->signedDistance(corner_of_first), 1e-4);
  hull->~btConvexHullShape();
}

std::string stderrOf(btCollisionShape& shape) {
  World world;
  world.addShape(shape, 0, Vec3::Zero(), Pose());
  world.add(cube(), Pose());
  testing::internal::CaptureStderr();
  world.step(3);
  return testing::internal::GetCapturedStderr();
}

TEST(NativeShapes, ThatCannotCollideAreRefusedWithOneMessage) {
  btGImpactCompoundShape gimpact;
  btBoxShape box(at(0.01, 0.01, 0.01));
  gimpact.addChildShape(btTransform::getIdentity(), &box);
  gimpact.updateBound();
  btConvex2dShape flat(&box);
  btConvexHullShape line;
  line.addPoint(at(0, 0, 0));
  line.addPoint(at(0.01, 0, 0));
  btConvexHullShape broken;
  for (const btVector3& p : slabCorners(0.01, -0.01, 0.01)) broken.addPoint(p);
  broken.getUnscaledPoints()[3].setX(std::numeric_limits<btScalar>::quiet_NaN());
  struct Nothing : UserConcave {  // like btSdfCollisionShape, which reports no triangles
    void processAllTriangles(btTriangleCallback*, const btVector3&, const btVector3&) const override {}
  } nothing;
  struct TooMuch : UserConcave {
    void processAllTriangles(btTriangleCallback* visit, const btVector3&, const btVector3&) const override {
      btVector3 corners[3] = {at(0, 0, 0), at(0.01, 0, 0), at(0, 0.01, 0)};
      for (std::size_t i = 0; i <= kMaxNativeTriangles; ++i) visit->processTriangle(corners, 0, 0);
    }
  } too_much;
  Ground ground;
  const btConcaveShape* extent = &ground.keep<btBvhTriangleMeshShape>(&slabMesh(ground), true);
  nothing.other = too_much.other = extent;
  for (const auto& [shape, reason] :
       std::initializer_list<std::pair<btCollisionShape*, const char*>>{{&gimpact, "btCompoundShape"},
                                                                        {&flat, "two-dimensional worlds"},
                                                                        {&line, "fewer than three corners"},
                                                                        {&broken, "not a number"},
                                                                        {&nothing, "reports no triangles"},
                                                                        {&too_much, "split it"}}) {
    const std::string message = stderrOf(*shape);
    EXPECT_NE(message.find("do not collide"), std::string::npos) << shape->getName();
    EXPECT_NE(message.find(reason), std::string::npos) << message;
    EXPECT_EQ(message.find("do not collide"), message.rfind("do not collide")) << "reported more than once";
  }
}

TEST(NativeShapes, AnEmptyShapeHasNoContactAndNoMessage) {
  btEmptyShape empty;
  EXPECT_EQ(stderrOf(empty), "");
}

}  // namespace
}  // namespace vps::bullet
