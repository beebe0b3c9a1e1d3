// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/install.h"

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "bullet_bridge/world.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::cube;
using test::SolverKind;
using test::World;

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

TEST(Install, WithoutItShapesPassThroughEachOther) {
  World world;
  uninstall(world.dispatcher);
  EXPECT_FALSE(isInstalled(world.dispatcher));
  world.add(cube(), Pose(), true);
  btRigidBody& body = world.add(cube(), Pose::translation(Vec3(0, 0, 0.011)));
  world.step(200);
  EXPECT_LT(body.getWorldTransform().getOrigin().z(), 0);
}

TEST(Install, ASecondCallReplacesTheSettings) {
  World world;
  Settings settings;
  settings.contact_limit = 8;
  install(world.dispatcher, settings);
  world.add(cube(), Pose(), true);
  btRigidBody& body = world.add(cube(), Pose::translation(Vec3(0, 0, 0.010)));
  world.step(100);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.010, 1e-6);
  int contacts = 0;
  for (int m = 0; m < world.dispatcher.getNumManifolds(); ++m)
    contacts += world.dispatcher.getManifoldByIndexInternal(m)->getNumContacts();
  EXPECT_GE(contacts, 8);
  EXPECT_LT(contacts, 32);  // checks of steps add some; without the second install() there are 32 or more
}

TEST(Install, ABodyPlacedIntoAnotherIsReportedAndOneThatFallsOnItIsNot) {
  constexpr double kOverlap_m = 1e-3;
  const auto startAt = [](double z_m) {
    World world;
    world.add(cube(), Pose(), true);
    world.add(cube(), Pose::translation(Vec3(0, 0, z_m))).setLinearVelocity(btVector3(0, 0, toBt(-0.5)));
    world.step(20);
    return stats(world.dispatcher);
  };
  EXPECT_EQ(startAt(0.0105).overlapping_starts, 0u);
  testing::internal::CaptureStderr();
  const Stats stats = startAt(0.010 - kOverlap_m);
  const std::string words = testing::internal::GetCapturedStderr();
  EXPECT_NE(words.find("begin at least 1 mm inside each other"), std::string::npos) << words;
  EXPECT_NE(words.find("(0, 0, 0.009) m"), std::string::npos) << words;  // the position of one body
  EXPECT_EQ(stats.overlapping_starts, 1u);
  EXPECT_NEAR(stats.deepest_start_m, kOverlap_m,
              1e-7);  // the distance of faces is exact except for float rounding
}

TEST(Install, RefusesSettingsThatCannotWork) {
  World world;
  Settings settings;
  settings.contact_limit = 3;
  EXPECT_THROW(install(world.dispatcher, settings), std::invalid_argument);
  settings = {};
  settings.contact_margin_m = 0;
  EXPECT_THROW(install(world.dispatcher, settings), std::invalid_argument);
  settings = {};
  settings.candidate_limit = settings.contact_limit - 1;
  EXPECT_THROW(install(world.dispatcher, settings), std::invalid_argument);
}

Box contactExtent(World& world) {
  Box box;
  for (int m = 0; m < world.dispatcher.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *world.dispatcher.getManifoldByIndexInternal(m);
    for (int i = 0; i < manifold.getNumContacts(); ++i)
      box.add(fromBt(manifold.getContactPoint(i).getPositionWorldOnA()));
  }
  return box;
}

TEST(Install, ExaminesEveryPointOfALargeFace) {
  // More than 20,000 points touch at once. Without the points of one corner the plate would tip over it.
  const Built plate = test::build(makeBox(Vec3(0.04, 0.04, 0.002)), 7850, 0.5e-3, 0.25e-3);
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  const Built ground = test::build(makeBox(Vec3(0.05, 0.05, 0.01)), 7850, 0.5e-3, 2e-3);
  for (btCollisionShape* under : std::initializer_list<btCollisionShape*>{&plane, ground.shape.get()}) {
    World world;
    const double top_m = under == &plane ? 0 : 0.005;
    world.addShape(*under, 0, Vec3::Zero(), Pose());
    world.add(plate, Pose::translation(Vec3(0, 0, top_m + 0.001)));
    world.step();
    EXPECT_GT(stats(world.dispatcher).points_tested, 20000u) << under->getName();
    EXPECT_EQ(stats(world.dispatcher).left_out, 0u) << under->getName();
    // Some of the 64 contacts are at every rim: no farther inside than one cell of the reduction, 1/8 of half
    // a diagonal.
    const Box held = contactExtent(world);
    EXPECT_GE(std::min(held.size().x(), held.size().y()), 0.04 - 2 * 0.0035) << under->getName();
  }
}

TEST(Install, ALimitOnCandidatesIsAppliedAndCounted) {
  // The result must not depend on the larger buffers of the test ExaminesEveryPointOfALargeFace.
  btStaticPlaneShape plane(btVector3(0, 0, 1), toBt(0.005));
  for (btCollisionShape* under : std::initializer_list<btCollisionShape*>{&plane, cube().shape.get()}) {
    Settings settings;
    settings.sides = Sides::One;
    settings.candidate_limit = 80;
    World world(SolverKind::Constraint, settings);
    world.addShape(*under, 0, Vec3::Zero(), Pose());
    world.add(cube(), Pose::translation(Vec3(0, 0, 0.010)));
    world.step();
    EXPECT_EQ(stats(world.dispatcher).candidates, 80u) << under->getName();
    EXPECT_GT(stats(world.dispatcher).left_out, 0u) << under->getName();
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

TEST(Install, CompoundsOfShapesCollide) {
  World world;
  btCompoundShape compound;
  compound.addChildShape(toBt(Pose::translation(Vec3(0, 0, -0.02))), cube().shape.get());
  world.addShape(compound, 0, Vec3::Zero(), Pose::translation(Vec3(0, 0, 0.02)));
  btRigidBody& body = world.add(cube(), Pose::translation(Vec3(0, 0, 0.0101)));
  world.step(300);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.010, 1e-6);
}

TEST(Install, ManyPairsSurviveBulletsAlgorithmPool) {
  // A pool for two algorithms: the third algorithm is allocated on the heap.
  btDefaultCollisionConstructionInfo small;
  small.m_defaultMaxCollisionAlgorithmPoolSize = 2;
  btDefaultCollisionConfiguration config(small);
  btCollisionDispatcher dispatcher(&config);
  btDbvtBroadphase broadphase;
  Solver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &config);
  install(dispatcher);
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
  uninstall(dispatcher);
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

// A dispatcher's table, which only derived classes can read.
struct Tables : btCollisionDispatcher {
  static std::vector<btCollisionAlgorithmCreateFunc*> of(const btCollisionDispatcher& d) {
    std::vector<btCollisionAlgorithmCreateFunc*> all;
    for (const auto table : {&Tables::m_doubleDispatchContactPoints, &Tables::m_doubleDispatchClosestPoints})
      for (const auto& row : d.*table) all.insert(all.end(), std::begin(row), std::end(row));
    return all;
  }
};

TEST(Uninstall, RestoresTheDispatcher) {
  btDefaultCollisionConfiguration config;
  btCollisionDispatcher dispatcher(&config);
  btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher);  // pairs GImpact with all types, also Shape's
  const auto before = Tables::of(dispatcher);
  install(dispatcher);
  EXPECT_NE(Tables::of(dispatcher), before);
  install(dispatcher);
  uninstall(dispatcher);
  EXPECT_EQ(Tables::of(dispatcher), before);
  uninstall(dispatcher);
  EXPECT_EQ(Tables::of(dispatcher), before);
}

TEST(Install, ComesBeforeOrAfterGImpactsRegistration) {
  btTriangleMesh mesh;
  for (const auto& t : cube().mesh.triangles)
    mesh.addTriangle(toBt(cube().mesh.vertices[t[0]]), toBt(cube().mesh.vertices[t[1]]),
                     toBt(cube().mesh.vertices[t[2]]));
  btGImpactMeshShape gimpact(&mesh);
  gimpact.updateBound();
  for (const bool is_again : {false, true}) {
    World world;  // installs
    btGImpactCollisionAlgorithm::registerAlgorithm(&world.dispatcher);
    if (is_again) install(world.dispatcher);
    world.addShape(gimpact, 0, Vec3::Zero(), Pose());
    btRigidBody& body = world.add(cube(), Pose::translation(Vec3(0, 0, 0.0101)));
    world.step(200);
    EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.010,
                1e-6);  // GImpact's own contact is wrong by 100 um
  }
}

TEST(Install, WhileBodiesTouchGivesTheirPairsContact) {
  World world;
  uninstall(world.dispatcher);
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  world.addShape(plane, 0, Vec3::Zero(), Pose());
  btRigidBody& body = world.add(cube(), Pose::translation(Vec3(0, 0, 0.0055)));
  world.step(3);
  install(world.dispatcher);
  world.step(200);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.005, 1e-6);
}

TEST(Install, OfTwoDispatchersIsIndependent) {
  World first, second;
  uninstall(first.dispatcher);
  EXPECT_FALSE(isInstalled(first.dispatcher));
  EXPECT_TRUE(isInstalled(second.dispatcher));
  second.add(cube(), Pose(), true);
  btRigidBody& body = second.add(cube(), Pose::translation(Vec3(0, 0, 0.0101)));
  second.step(100);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.010, 5e-6);
  EXPECT_EQ(stats(first.dispatcher).pair_updates, 0u);
}

TEST(Install, ADispatcherAtTheAddressOfADestroyedOneStartsWithoutIt) {
  btDefaultCollisionConfiguration config;
  alignas(btCollisionDispatcher) unsigned char room[sizeof(btCollisionDispatcher)];
  auto* dispatcher = new (room) btCollisionDispatcher(&config);
  install(*dispatcher);
  EXPECT_TRUE(isInstalled(*dispatcher));
  dispatcher->~btCollisionDispatcher();  // without uninstall
  dispatcher = new (room) btCollisionDispatcher(&config);
  EXPECT_FALSE(isInstalled(*dispatcher));
  install(*dispatcher);
  EXPECT_TRUE(isInstalled(*dispatcher));
  EXPECT_EQ(stats(*dispatcher).pair_updates, 0u);
  uninstall(*dispatcher);
  EXPECT_FALSE(isInstalled(*dispatcher));
  dispatcher->~btCollisionDispatcher();
}

TEST(Uninstall, ReportsExistingPairsWhichKeepTheirContact) {
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  World world;
  world.addShape(plane, 0, Vec3::Zero(), Pose());
  btRigidBody& body = world.add(cube(), Pose::translation(Vec3(0, 0, 0.005)));
  world.step(10);
  testing::internal::CaptureStderr();
  uninstall(world.dispatcher);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("keep VPS contact"), std::string::npos);
  world.step(100);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.005, 1e-6);
  testing::internal::CaptureStderr();
  uninstall(world.dispatcher);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Install, AnotherShapeOfOurTypeIsRefusedWithAMessage) {
  struct Foreign : btTriangleMeshShape {
    explicit Foreign(btStridingMeshInterface* mesh) : btTriangleMeshShape(mesh) {
      m_shapeType = FAST_CONCAVE_MESH_PROXYTYPE;
    }
  };
  btTriangleMesh mesh;
  mesh.addTriangle(btVector3(-1, -1, 0), btVector3(1, -1, 0), btVector3(0, 1, 0));
  Foreign a(&mesh);
  World world;
  world.addShape(a, 0, Vec3::Zero(), Pose());
  btRigidBody& part = world.add(cube(), Pose::translation(Vec3(0, 0, 0.0051)));
  world.step(100);
  EXPECT_NEAR(part.getWorldTransform().getOrigin().z(), 0.005, 1e-6) << "met as a mesh";
  world.addShape(a, 1, Vec3::Ones(), Pose());
  testing::internal::CaptureStderr();
  world.step(3);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("is reserved"), std::string::npos);
}

TEST(TuneWorld, ReportsWhatItChangedAndNothingTheSecondTime) {
  World world;  // the constructor calls tuneWorld
  EXPECT_TRUE(tuneWorld(*world.world).empty());
  world.world->getSolverInfo().m_linearSlop = toBt(1e-3);
  const WorldTuning tuning = tuneWorld(*world.world);
  ASSERT_EQ(tuning.changes.size(), 1u);
  EXPECT_NE(tuning.changes[0].find("linear slop"), std::string::npos);
}

TEST(RestoreWorld, RestoresTheBitsExceptForWhatTheUserChangedSince) {
  World world;
  gDbvtMargin = toBt(0.05);
  world.world->getSolverInfo() = btContactSolverInfo();
  btRigidBody& body = world.add(cube(), Pose());
  btRigidBody& own = world.add(cube(), Pose::translation(Vec3(1, 0, 0)));
  own.setSleepingThresholds(toBt(0.3), toBt(0.2));
  const btContactSolverInfo before = world.world->getSolverInfo();
  const WorldTuning tuning = tuneWorld(*world.world);
  EXPECT_GE(tuning.changes.size(), 8u);
  EXPECT_EQ(body.getLinearSleepingThreshold(), toBt(kSleepSpeed_m_s));
  EXPECT_EQ(own.getLinearSleepingThreshold(), toBt(0.3)) << "the user's";
  world.world->getSolverInfo().m_numIterations = 33;
  restoreWorld(*world.world, tuning);
  const btContactSolverInfo& after = world.world->getSolverInfo();
  EXPECT_EQ(after.m_numIterations, 33);
  EXPECT_EQ(after.m_splitImpulsePenetrationThreshold, before.m_splitImpulsePenetrationThreshold);
  EXPECT_EQ(after.m_splitImpulseTurnErp, before.m_splitImpulseTurnErp);
  EXPECT_EQ(after.m_warmstartingFactor, before.m_warmstartingFactor);
  EXPECT_EQ(after.m_minimumSolverBatchSize, before.m_minimumSolverBatchSize);
  EXPECT_EQ(after.m_solverMode, before.m_solverMode);
  EXPECT_EQ(gDbvtMargin, toBt(0.05));
  EXPECT_EQ(body.getLinearSleepingThreshold(), toBt(0.8));
  EXPECT_EQ(body.getAngularSleepingThreshold(), toBt(1));
  EXPECT_EQ(own.getLinearSleepingThreshold(), toBt(0.3));
  tuneWorld(*world.world);
}

TEST(TuneWorld, RefusesASolverWithoutIterations) {
  World world;
  EXPECT_THROW(tuneWorld(*world.world, 0), std::invalid_argument);
}

TEST(TuneWorld, KeepsAPartAwakeThatSlidesAtATenthOfAMetreASecond) {
  for (const bool is_tuned : {false, true}) {
    World world;
    btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
    world.addShape(plane, 0, Vec3::Zero(), Pose(), 0);
    btRigidBody& body = world.add(cube(), Pose::translation(Vec3(0, 0, 0.005)), false, 0);
    body.forceActivationState(ACTIVE_TAG);
    body.setLinearVelocity(btVector3(toBt(0.1), 0, 0));
    if (is_tuned) tuneWorld(*world.world);
    testing::internal::CaptureStderr();
    world.step(3000);
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_EQ(said.find("fall asleep") == std::string::npos, is_tuned) << said;
    // Without tuneWorld, Bullet stops the body after two seconds.
    EXPECT_NEAR(body.getWorldTransform().getOrigin().x(), is_tuned ? 0.3 : 0.2, 2e-3);
  }
}

}  // namespace
}  // namespace vps::bullet
