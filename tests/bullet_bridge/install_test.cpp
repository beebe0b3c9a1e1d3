// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/install.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "bullet_bridge/world.h"

namespace vps {
namespace {

using test::Built;
using test::Solver;
using test::World;

const Built& cube() {
  static const Built built = test::build(makeBox(Vec3::Constant(0.01)), 7850, 0.5e-3, 1e-3);
  return built;
}

// Contact points of two objects, as contactPairTest reports them.
struct Points : btCollisionWorld::ContactResultCallback {
  std::vector<btManifoldPoint> points;
  explicit Points(double threshold_m) { m_closestDistanceThreshold = toBt(threshold_m); }
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    points.push_back(point);
    return 0;
  }
};

TEST(Install, WithoutItVpsShapesPassThroughEachOther) {
  World world;
  uninstallVps(world.dispatcher);
  EXPECT_FALSE(isVpsInstalled(world.dispatcher));
  world.add(cube(), Pose(), true);
  btRigidBody& body = world.add(cube(), Pose::translation(Vec3(0, 0, 0.011)));
  world.step(200);
  EXPECT_LT(body.getWorldTransform().getOrigin().z(), 0);
}

TEST(Install, TwiceIsAsOnceWithTheLaterSettings) {
  World world;
  VpsBulletSettings settings;
  settings.contact_limit = 8;
  installVps(world.dispatcher, settings);
  world.add(cube(), Pose(), true);
  btRigidBody& body = world.add(cube(), Pose::translation(Vec3(0, 0, 0.010)));
  world.step(100);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.010, 1e-6);
  int contacts = 0;
  for (int m = 0; m < world.dispatcher.getNumManifolds(); ++m)
    contacts += world.dispatcher.getManifoldByIndexInternal(m)->getNumContacts();
  EXPECT_EQ(contacts, 8);
}

TEST(Install, RefusesSettingsThatCannotWork) {
  World world;
  VpsBulletSettings settings;
  settings.contact_limit = 3;
  EXPECT_THROW(installVps(world.dispatcher, settings), std::invalid_argument);
  settings = {};
  settings.slack_m = 0;
  EXPECT_THROW(installVps(world.dispatcher, settings), std::invalid_argument);
  settings = {};
  settings.candidate_limit = settings.contact_limit - 1;
  EXPECT_THROW(installVps(world.dispatcher, settings), std::invalid_argument);
}

TEST(Install, LooksAtEveryPointOfALargeFace) {
  // More than 20,000 points touch at once; without those of one corner the plate would tip over it.
  const Built plate = test::build(makeBox(Vec3(0.04, 0.04, 0.002)), 7850, 0.5e-3, 0.25e-3);
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  const Built ground = test::build(makeBox(Vec3(0.05, 0.05, 0.01)), 7850, 0.5e-3, 2e-3);
  for (btCollisionShape* under : std::initializer_list<btCollisionShape*>{&plane, ground.shape.get()}) {
    World world;
    const double top_m = under == &plane ? 0 : 0.005;
    world.addShape(*under, 0, Vec3::Zero(), Pose());
    world.add(plate, Pose::translation(Vec3(0, 0, top_m + 0.001)));
    world.step();
    EXPECT_GT(vpsStats(world.dispatcher).candidates, 20000u) << under->getName();
    EXPECT_EQ(vpsStats(world.dispatcher).left_out, 0u) << under->getName();
  }
}

TEST(Install, ALimitOnCandidatesIsKeptAndCounted) {
  // After the test above too, whose buffers were larger.
  btStaticPlaneShape plane(btVector3(0, 0, 1), toBt(0.005));
  for (btCollisionShape* under : std::initializer_list<btCollisionShape*>{&plane, cube().shape.get()}) {
    VpsBulletSettings settings;
    settings.sides = Sides::One;
    settings.candidate_limit = 80;
    World world(Solver::Vps, settings);
    world.addShape(*under, 0, Vec3::Zero(), Pose());
    world.add(cube(), Pose::translation(Vec3(0, 0, 0.010)));
    world.step();
    EXPECT_EQ(vpsStats(world.dispatcher).candidates, 80u) << under->getName();
    EXPECT_GT(vpsStats(world.dispatcher).left_out, 0u) << under->getName();
  }
}

TEST(Install, AQueryFindsPointsInBothOrdersWithOppositeNormals) {
  World world;
  btRigidBody& low = world.add(cube(), Pose(), true);
  btRigidBody& high = world.add(cube(), Pose::translation(Vec3(0.001, 0, 0.0102)));
  Points from_low(0.5e-3), from_high(0.5e-3), touching(0);
  world.world->contactPairTest(&low, &high, from_low);
  world.world->contactPairTest(&high, &low, from_high);
  world.world->contactPairTest(&high, &low, touching);
  ASSERT_FALSE(from_low.points.empty());
  ASSERT_EQ(from_low.points.size(), from_high.points.size());
  EXPECT_TRUE(touching.points.empty());
  for (const btManifoldPoint& point : from_low.points) {
    EXPECT_NEAR(point.m_normalWorldOnB.z(), -1, 1e-6);  // from B (high) to A (low)
    EXPECT_NEAR(point.m_distance1, 0.2e-3, 1e-7);
  }
  for (const btManifoldPoint& point : from_high.points) EXPECT_NEAR(point.m_normalWorldOnB.z(), 1, 1e-6);
}

TEST(Install, CompoundsOfVpsShapesCollide) {
  World world;
  btCompoundShape compound;
  compound.addChildShape(toBt(Pose::translation(Vec3(0, 0, -0.02))), cube().shape.get());
  world.addShape(compound, 0, Vec3::Zero(), Pose::translation(Vec3(0, 0, 0.02)));
  btRigidBody& body = world.add(cube(), Pose::translation(Vec3(0, 0, 0.0101)));
  world.step(300);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.010, 1e-6);
}

TEST(Install, ManyPairsSurviveBulletsAlgorithmPool) {
  // A pool of two: the third algorithm comes from the heap.
  btDefaultCollisionConstructionInfo small;
  small.m_defaultMaxCollisionAlgorithmPoolSize = 2;
  btDefaultCollisionConfiguration config(small);
  btCollisionDispatcher dispatcher(&config);
  btDbvtBroadphase broadphase;
  VpsSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &config);
  installVps(dispatcher);
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  btRigidBody ground(0, nullptr, &plane);
  world.addRigidBody(&ground);
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  for (int i = 0; i < 6; ++i) {
    bodies.push_back(std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(
        toBt(cube().frame.mass_kg), nullptr, cube().shape.get(), toBt(cube().frame.inertia_kg_m2))));
    bodies.back()->setWorldTransform(toBt(Pose::translation(Vec3(0.02 * i, 0, 0.005))));
    world.addRigidBody(bodies.back().get());
  }
  for (int i = 0; i < 50; ++i) world.stepSimulation(toBt(1e-3), 0);
  for (const auto& body : bodies) EXPECT_NEAR(body->getWorldTransform().getOrigin().z(), 0.005, 1e-6);
  for (const auto& body : bodies) world.removeRigidBody(body.get());
  world.removeRigidBody(&ground);
  uninstallVps(dispatcher);
}

TEST(Install, TwoRunsGiveTheSameBits) {
  const auto run = [] {
    World world;
    world.add(cube(), Pose(), true);
    btRigidBody& body =
        world.add(cube(), Pose(rotationFromVector(Vec3(0.2, 0.1, 0.3)), Vec3(0.001, 0.002, 0.015)));
    world.step(300);
    return body.getWorldTransform();
  };
  const btTransform first = run(), second = run();
  EXPECT_EQ(first.getOrigin(), second.getOrigin());
  EXPECT_EQ(first.getBasis(), second.getBasis());
}

TEST(TuneWorld, SaysWhatItChangedAndNothingTheSecondTime) {
  World world;  // tunes already
  EXPECT_TRUE(tuneWorld(*world.world).empty());
  world.world->getSolverInfo().m_linearSlop = toBt(1e-3);
  const std::vector<std::string> said = tuneWorld(*world.world);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("linear slop"), std::string::npos);
}

}  // namespace
}  // namespace vps
