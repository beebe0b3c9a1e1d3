// SPDX-License-Identifier: BSD-3-Clause
// Restitution in the solver changes the velocity only; the displacement is that without restitution.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "bullet_bridge/world.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::kIsDouble;
using test::plate;
using test::SolverKind;
using test::steelBox;
using test::World;

constexpr double kGap_m = 0.4e-3, kSpeed_m_s = 1;

/// A box of 20 x 15 x 10 mm that falls onto a plate without gravity.
struct Fall {
  World world;
  Built box = steelBox(), ground = plate();
  btRigidBody* body = nullptr;

  explicit Fall(double e, const SolverSettings& settings = {})
      : world(SolverKind::Constraint, {}, 100, settings) {
    world.world->setGravity(btVector3(0, 0, 0));
    world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true, 0).setRestitution(1);
    body = &world.add(box, Pose::translation(Vec3(0, 0, 0.005 + kGap_m)), false, 0);
    body->setRestitution(toBt(e));
    body->setLinearVelocity(btVector3(0, 0, toBt(-kSpeed_m_s)));
  }
  [[nodiscard]] double height_m() const { return body->getWorldTransform().getOrigin().z() - 0.005; }
  [[nodiscard]] double speed_m_s() const { return body->getLinearVelocity().z(); }
};

TEST(Restitution, TheStepOfTheImpactEndsAtContactAndBouncesInFull) {
  for (const int sweeps_only : {0, 1}) {
    SolverSettings settings;
    if (sweeps_only) settings.iteration_limit = 39;
    for (const double e : {0.0, 0.3, 1.0}) {
      Fall fall(e, settings);
      fall.world.step();
      EXPECT_NEAR(fall.height_m(), 0, 1e-6) << e;
      EXPECT_NEAR(fall.speed_m_s(), e > 0 ? e * kSpeed_m_s : -kGap_m / 1e-3, 1e-3) << e;
      fall.world.step();
      EXPECT_NEAR(fall.height_m(), e * kSpeed_m_s * 1e-3, 2e-6) << e;
    }
  }
}

TEST(Restitution, MoreThanOneOrNotANumberIsTakenAsOneOrNone) {
  for (const auto& [e, expected] : {std::pair(3.0, 1.0), std::pair(std::nan(""), 0.0)}) {
    Fall fall(e);
    fall.world.step(2);
    EXPECT_NEAR(fall.speed_m_s(), expected * kSpeed_m_s, 1e-3);
  }
}

TEST(Restitution, ABodyAtRestUnderGravityDoesNotBounce) {
  Fall fall(1);
  fall.world.world->setGravity(btVector3(0, 0, toBt(-9.81)));
  fall.body->setLinearVelocity(btVector3(0, 0, 0));
  fall.body->setWorldTransform(btTransform(btMatrix3x3::getIdentity(), btVector3(0, 0, toBt(0.005))));
  for (int i = 0; i < 100; ++i) {
    fall.world.step();
    EXPECT_LE(std::abs(fall.speed_m_s()), kIsDouble ? 1e-6 : 1e-4);
  }
}

// With gravity each bounce returns to the height of the drop, for any phase of the step.
TEST(Restitution, UnderGravityNoHeightIsLost) {
  for (const double height_m : {20e-3, 21.3e-3}) {
    Fall fall(1);
    fall.world.world->setGravity(btVector3(0, 0, toBt(-9.81)));
    fall.body->setLinearVelocity(btVector3(0, 0, 0));
    btTransform start = btTransform::getIdentity();
    start.setOrigin(btVector3(0, 0, toBt(0.005 + height_m)));
    fall.body->setWorldTransform(start);
    double peak_m = 0, last_m = 0;
    int bounces = 0;
    bool was_rising = false;
    for (int i = 0; i < 700; ++i) {
      const double before_m = fall.height_m();
      fall.world.step();
      const bool is_rising = fall.height_m() > before_m;
      if (is_rising && !was_rising && ++bounces > 1) last_m = peak_m;
      if (is_rising && !was_rising) peak_m = 0;
      peak_m = std::max(peak_m, fall.height_m());
      was_rising = is_rising;
    }
    EXPECT_GE(bounces, 5);
    EXPECT_NEAR(last_m, height_m, 0.01 * height_m);
  }
}

// The host moves the plate: the rebound is e times the speed of approach, relative to the plate.
TEST(Restitution, APlateThatIsMovedThrowsBack) {
  for (const double plate_m_s : {-0.6, -0.2, 0.5, 2.0})
    for (const double e : {0.3, 1.0}) {
      Fall fall(e);
      btRigidBody& plate = *fall.world.bodies.front();
      plate.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
      for (int i = 0; i < 8; ++i) {
        btTransform X = plate.getWorldTransform();
        X.getOrigin() += btVector3(0, 0, toBt(1e-3 * plate_m_s));
        plate.setWorldTransform(X);
        fall.world.step();
      }
      EXPECT_NEAR(fall.speed_m_s(), plate_m_s + e * (plate_m_s + kSpeed_m_s), 2e-3) << plate_m_s << ", " << e;
      EXPECT_LE(fall.body->getAngularVelocity().length(), 0.1);
    }
}

// A box hits two walls flush, one of them without restitution. The edges rest at a gap, the faces between
// them at a slightly larger one, and the box leaves without turning.
TEST(Restitution, ABoxThatLandsFlushDoesNotTurn) {
  Fall fall(0.4);
  fall.world
      .add(fall.ground, Pose(rotationFromVector(Vec3(0, 0.5 * std::numbers::pi, 0)), Vec3(-0.0153, 0, 0)),
           true, 0)
      .setRestitution(0);
  fall.body->setLinearVelocity(btVector3(toBt(-2.1), toBt(0.7), toBt(-kSpeed_m_s)));
  fall.world.step(4);
  const btVector3 v = fall.body->getLinearVelocity();
  EXPECT_NEAR(v.x(), 0, 2e-3);
  EXPECT_NEAR(v.y(), 0.7, 2e-3);
  EXPECT_NEAR(v.z(), 0.4 * kSpeed_m_s, 2e-3);
  EXPECT_LE(fall.body->getAngularVelocity().length(), 0.1);
}

// A part at rest on a plate is not thrown up by its weight when another part hits it.
TEST(Restitution, APartAtRestStaysWhereAnotherBouncesOnIt) {
  Fall fall(1);
  fall.world.world->setGravity(btVector3(0, 0, toBt(-9.81)));
  const Built wide = plate();
  btRigidBody& under = fall.world.add(wide, Pose::translation(Vec3(0, 0, 0.005)), false, 0);
  under.setRestitution(1);
  fall.world.bodies.front()->setRestitution(0);
  btTransform start = btTransform::getIdentity();
  start.setOrigin(btVector3(0, 0, toBt(0.015 + kGap_m)));
  fall.body->setWorldTransform(start);
  fall.body->setRestitution(1);
  for (int i = 0; i < 50; ++i) {
    fall.world.step();
    EXPECT_NEAR(under.getWorldTransform().getOrigin().z(), 0.005, 1e-6) << i;
    EXPECT_LE(std::abs(under.getLinearVelocity().z()), kIsDouble ? 1e-6 : 1e-4) << i;
  }
}

// Friction at the impact: at most mu times the normal impulse m (1 + e) v.
TEST(Restitution, FrictionAtTheImpactIsThatOfTheWholeImpulse) {
  constexpr double mu = 0.1, e = 0.5, slide_m_s = 1;
  World world(SolverKind::Constraint);
  world.world->setGravity(btVector3(0, 0, 0));
  const Built box = steelBox(), ground = plate();
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true, mu).setRestitution(1);
  btRigidBody& body = world.add(box, Pose::translation(Vec3(0, 0, 0.005 + kGap_m)), false, mu);
  body.setRestitution(toBt(e));
  body.setLinearVelocity(btVector3(toBt(slide_m_s), 0, toBt(-kSpeed_m_s)));
  const double energy_J = body.getLinearVelocity().length2();
  world.step();
  // The friction also turns the box, which lowers the normal impulse at one edge: within a tenth.
  EXPECT_NEAR(body.getLinearVelocity().x(), slide_m_s - mu * (1 + e) * kSpeed_m_s,
              0.1 * mu * (1 + e) * kSpeed_m_s);
  EXPECT_LE(body.getLinearVelocity().length2(), energy_J);
}

// Joints take part in the impact: a body that hangs on the hit body moves with it.
TEST(Restitution, BodiesOnAFixedJointBounceAsOne) {
  World world(SolverKind::Constraint);
  world.world->setGravity(btVector3(0, 0, 0));
  const Built box = steelBox(), ground = plate();
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true, 0).setRestitution(1);
  btRigidBody& low = world.add(box, Pose::translation(Vec3(0, 0, 0.005 + kGap_m)), false, 0);
  btRigidBody& high = world.add(box, Pose::translation(Vec3(0, 0, 0.025 + kGap_m)), false, 0);
  low.setRestitution(1);
  btTransform up = btTransform::getIdentity(), down = btTransform::getIdentity();
  up.setOrigin(btVector3(0, 0, toBt(0.01)));
  down.setOrigin(btVector3(0, 0, toBt(-0.01)));
  btFixedConstraint joint(low, high, up, down);
  world.world->addConstraint(&joint, true);
  for (btRigidBody* body : {&low, &high}) body->setLinearVelocity(btVector3(0, 0, toBt(-kSpeed_m_s)));
  world.step(3);
  for (const btRigidBody* body : {&low, &high}) EXPECT_NEAR(body->getLinearVelocity().z(), kSpeed_m_s, 1e-2);
  world.world->removeConstraint(&joint);
}

// The solver finds no displacement without overlap and shortens the step. The bodies still bounce.
TEST(Restitution, AnImpactThroughALightBodyKeepsTheEnergy) {
  constexpr int kSteps = 20;
  // Each step rounds the velocities of the two heavy bodies, which are at most that of the start.
  constexpr double kMomentum =
      std::max(1e-9, kSteps * 2 * 0.5 * double{std::numeric_limits<btScalar>::epsilon()});
  const Built box = steelBox();
  for (const double ratio : {1e-3, 1e-5, 1e-6}) {
    World world;
    world.world->setGravity(btVector3(0, 0, 0));
    std::vector<btRigidBody*> bodies;
    for (int i = 0; i < 3; ++i) {
      btRigidBody& body = world.add(box, Pose::translation({i * 20.1e-3, 0, 0}), false, 0);
      if (i == 1) body.setMassProps(toBt(ratio) / body.getInvMass(), toBt(ratio) * body.getLocalInertia());
      body.setRestitution(1);
      bodies.push_back(&body);
    }
    bodies[0]->setLinearVelocity(btVector3(1, 0, 0));
    const double start_J = 0.5 / bodies[0]->getInvMass(), start_Ns = 1 / bodies[0]->getInvMass();
    world.step(kSteps);
    double energy_J = 0, momentum_Ns = 0;
    for (const btRigidBody* body : bodies) {
      const btVector3 w_B = body->getAngularVelocity() * body->getWorldTransform().getBasis();
      energy_J += 0.5 * body->getLinearVelocity().length2() / body->getInvMass() +
                  0.5 * w_B.dot(body->getLocalInertia() * w_B);
      momentum_Ns += body->getLinearVelocity().x() / body->getInvMass();
    }
    EXPECT_NEAR(energy_J, start_J, 1e-3 * start_J) << ratio;
    EXPECT_NEAR(momentum_Ns, start_Ns, kMomentum * start_Ns) << ratio;
  }
}

}  // namespace
}  // namespace vps::bullet
