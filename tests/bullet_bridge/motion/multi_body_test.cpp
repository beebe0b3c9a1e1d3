// SPDX-License-Identifier: BSD-3-Clause
// Parts as links of Bullet's btMultiBody: contact ahead of the motion, as for rigid bodies.
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bullet_bridge/world.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::cube;

/// A world of multibodies with a fixed plate, whose top is at z = 5 mm.
struct MultiWorld {
  btDefaultCollisionConfiguration config;
  btCollisionDispatcher dispatcher{&config};
  btDbvtBroadphase broadphase;
  btMultiBodyConstraintSolver solver;
  btMultiBodyDynamicsWorld world{&dispatcher, &broadphase, &solver, &config};
  btRigidBody ground{0, nullptr, test::onePlate().shape.get()};
  std::vector<std::unique_ptr<btMultiBody>> bodies;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders;

  MultiWorld() {
    install(dispatcher);
    tuneWorld(world);
    world.setGravity(btVector3(0, 0, toBt(-9.81)));
    ground.setWorldTransform(toBt(test::onePlate().frame.X_PB));
    world.addRigidBody(&ground);
  }
  ~MultiWorld() {
    for (auto& collider : colliders) world.removeCollisionObject(collider.get());
    for (auto& body : bodies) world.removeMultiBody(body.get());
    world.removeRigidBody(&ground);
    uninstall(dispatcher);
  }
  btMultiBodyLinkCollider& collide(btMultiBody& body, int link, const Built& part) {
    colliders.push_back(std::make_unique<btMultiBodyLinkCollider>(&body, link));
    btMultiBodyLinkCollider& collider = *colliders.back();
    collider.setCollisionShape(part.shape.get());
    if (link < 0) {
      collider.setWorldTransform(body.getBaseWorldTransform());
      body.setBaseCollider(&collider);
    } else {
      body.getLink(link).m_collider = &collider;
    }
    world.addCollisionObject(&collider, btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter);
    return collider;
  }
  btMultiBody& add(int links, bool is_fixed, const Vec3& at, double mass_kg, const Vec3& inertia) {
    bodies.push_back(std::make_unique<btMultiBody>(links, toBt(mass_kg), toBt(inertia), is_fixed, false));
    btMultiBody& body = *bodies.back();
    body.setBaseWorldTransform(toBt(Pose::translation(at)));
    body.setLinearDamping(0);
    body.setAngularDamping(0);
    return body;
  }
  void start(btMultiBody& body) {
    body.finalizeMultiDof();
    world.addMultiBody(&body);
  }
  /// Moves the colliders to the poses of base and joints.
  static void place(btMultiBody& body) {
    btAlignedObjectArray<btQuaternion> turns;
    btAlignedObjectArray<btVector3> origins;
    body.forwardKinematics(turns, origins);
    body.updateCollisionObjectWorldTransforms(turns, origins);
  }
  void step(int count) {
    for (int i = 0; i < count; ++i) world.stepSimulation(toBt(1e-3), 0);
  }
};

class FreeLink : public testing::TestWithParam<double> {};

TEST_P(FreeLink, StopsAtAPlateAtAnySpeed) {
  const double speed_m_s = GetParam();
  MultiWorld multi;
  btMultiBody& body =
      multi.add(0, false, Vec3(0, 0, 0.0153), cube().frame.mass_kg, cube().frame.inertia_kg_m2);
  multi.collide(body, -1, cube());
  multi.start(body);
  body.setBaseVel(btVector3(0, 0, toBt(-speed_m_s)));
  double lowest_m = 1;
  for (int i = 0; i < 300; ++i) {
    multi.step(1);
    lowest_m = std::min<double>(lowest_m, body.getBasePos().z());
  }
  // The cube's centre is half its edge above the plate. The tolerance is the residual of Bullet's solver: ten
  // micrometres are 1e-2 m/s in a step of 1 ms, for impacts of up to 50 m/s.
  EXPECT_GT(lowest_m, 0.010 - 10e-6);
  EXPECT_NEAR(body.getBasePos().z(), 0.010, 10e-6) << "rests there";
}

INSTANTIATE_TEST_SUITE_P(At, FreeLink, testing::Values(0.5, 2.0, 8.0, 20.0, 50.0),
                         [](const auto& info) { return "Speed" + std::to_string(int(10 * info.param)); });

TEST(LinkOfAChain, StopsAtAPlateAtAnySpeed) {
  // A fixed base, an arm of 30 mm that turns about y, and a part on its end that falls on the plate.
  for (const double spin_rad_s : {10.0, 100.0, 700.0}) {
    MultiWorld multi;
    btMultiBody& body = multi.add(2, true, Vec3(-0.03, 0, 0.010), 0, Vec3::Zero());
    const btQuaternion none(0, 0, 0, 1);
    const double light_kg = 1e-4;
    body.setupRevolute(0, toBt(light_kg), toBt(Vec3(1e-8, 1e-8, 1e-8)), -1, none, btVector3(0, 1, 0),
                       btVector3(0, 0, 0), btVector3(toBt(0.015), 0, 0), true);
    body.setupFixed(1, toBt(cube().frame.mass_kg), toBt(cube().frame.inertia_kg_m2), 0, none,
                    btVector3(toBt(0.015), 0, 0), btVector3(0, 0, 0), true);
    btMultiBodyLinkCollider& part = multi.collide(body, 1, cube());
    multi.start(body);
    // The arm starts raised by 30 degrees; a positive turn about y lowers it.
    body.setJointPos(0, toBt(-M_PI / 6));
    body.setJointVel(0, toBt(spin_rad_s));
    MultiWorld::place(body);
    double lowest_m = 1;
    for (int i = 0; i < 400; ++i) {
      multi.step(1);
      lowest_m = std::min<double>(lowest_m, part.getWorldTransform().getOrigin().z());
    }
    // The tolerance is the solver's residual; on its arc the part's corner meets the plate first, so that its
    // centre is higher.
    EXPECT_GT(lowest_m, 0.010 - 50e-6) << spin_rad_s;
    EXPECT_NEAR(part.getWorldTransform().getOrigin().z(), 0.010, 50e-6) << spin_rad_s;
  }
}

}  // namespace
}  // namespace vps::bullet
