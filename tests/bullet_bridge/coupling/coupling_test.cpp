// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/coupling.h"

#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bullet_bridge/world.h"

namespace vps::bullet {
namespace {

using test::SolverKind;
using test::World;

constexpr double kGravity = 9.81;

// In single precision, positions have a relative error of 6e-8: at 10 mm 1 nm, which with k = 2e3 N/m is 2
// uN.
constexpr bool kIsDouble = sizeof(btScalar) == 8;

CouplingGains gainsOf(double k_N_per_m, double mass_kg) {
  CouplingGains gains;
  gains.k_N_per_m = k_N_per_m;
  gains.b_Ns_per_m = 2 * std::sqrt(k_N_per_m * mass_kg);  // critical damping
  gains.k_Nm_per_rad = 4;
  gains.b_Nms_per_rad = 0.02;
  gains.max_force_N = 1e6;
  gains.max_torque_Nm = 1e6;
  return gains;
}

CouplingState targetAt(const Pose& X_W) {
  CouplingState target;
  target.X_W = X_W;
  target.is_coupled = true;
  return target;
}

class CouplingWithSolver : public testing::TestWithParam<SolverKind> {
 protected:
  World world{GetParam()};
  btBoxShape box{btVector3(0.01, 0.01, 0.01)};
  btRigidBody& addBox(double mass_kg, const Vec3& p = Vec3::Zero(), double friction = 0) {
    const double I = mass_kg * 2 * 0.02 * 0.02 / 12;
    return world.addShape(box, mass_kg, Vec3::Constant(I), Pose::translation(p), friction);
  }
};

TEST_P(CouplingWithSolver, HangsByItsWeightOverStiffness) {
  btRigidBody& part = addBox(0.05);
  CouplingConstraint coupling(part, Pose(), gainsOf(2000, 0.05));
  world.world->addConstraint(&coupling, true);
  coupling.setTarget(targetAt(Pose()));
  world.step(2000);
  const double sag_m = -part.getWorldTransform().getOrigin().z();
  EXPECT_NEAR(sag_m, 0.05 * kGravity / 2000, kIsDouble ? 1e-9 : 1e-7);
  EXPECT_NEAR(coupling.wrench().f.z(), 0.05 * kGravity, kIsDouble ? 1e-6 : 1e-4);
  // At rest the implicit law equals the explicit one.
  const Wrench F = couplingWrench(coupling.gains(), targetAt(Pose()), coupling.partState());
  EXPECT_LE((F.f - coupling.wrench().f).norm() + (F.tau - coupling.wrench().tau).norm(),
            kIsDouble ? 1e-6 : 1e-3);
  world.world->removeConstraint(&coupling);
}

TEST_P(CouplingWithSolver, GraspedOffCentreItTurnsUntilTorqueBalances) {
  // The part is grasped 10 mm from its centre: the weight turns it about the grasp point by tau / k_r, and
  // the lever shortens by cos(angle).
  btRigidBody& part = addBox(0.05);
  const Pose X_BG = Pose::translation(Vec3(0.01, 0, 0));
  CouplingConstraint coupling(part, X_BG, gainsOf(2000, 0.05));
  world.world->addConstraint(&coupling, true);
  coupling.setTarget(targetAt(X_BG));
  world.step(4000);
  const CouplingState state = coupling.partState();
  const double angle_rad = rotationVector(state.X_W.R).y();
  EXPECT_NEAR(std::abs(angle_rad), 0.05 * kGravity * 0.01 * std::cos(angle_rad) / 4, kIsDouble ? 1e-8 : 1e-6);
  EXPECT_NEAR(state.X_W.p.z(), -0.05 * kGravity / 2000, kIsDouble ? 1e-9 : 1e-7);
  world.world->removeConstraint(&coupling);
}

TEST_P(CouplingWithSolver, IsStableFromAGramToTenKilogramsAtAnyStiffness) {
  for (const double mass_kg : {1e-3, 0.1, 10.0})
    for (const double k : {2e3, 2e4, 2e5}) {
      World w{GetParam()};
      const double I = mass_kg * 2 * 0.02 * 0.02 / 12;
      btRigidBody& part = w.addShape(box, mass_kg, Vec3::Constant(I), Pose::translation(Vec3(0.005, 0, 0)));
      CouplingGains gains = gainsOf(k, mass_kg);
      gains.b_Ns_per_m = 0;
      gains.b_Nms_per_rad = 0;  // only the implicit step damps: the hardest case
      CouplingConstraint coupling(part, Pose::translation(Vec3(0, 0.01, 0)), gains);
      w.world->setGravity(btVector3(0, 0, 0));
      w.world->addConstraint(&coupling, true);
      coupling.setTarget(targetAt(Pose::translation(Vec3(0, 0.01, 0))));
      double energy_J = 0.5 * k * 0.005 * 0.005;
      for (int i = 0; i < 1000; ++i) {
        w.step();
        const CouplingState state = coupling.partState();
        const Vec3 e = Vec3(0, 0.01, 0) - state.X_W.p;
        const Vec3 r = rotationVector(state.X_W.R);
        const double now_J = 0.5 * k * e.squaredNorm() + 0.5 * 4 * r.squaredNorm() +
                             0.5 * mass_kg * fromBt(part.getLinearVelocity()).squaredNorm() +
                             0.5 * I * fromBt(part.getAngularVelocity()).squaredNorm();
        // For a linear spring implicit Euler loses energy in every step. With rotation the spring is linear
        // only to second order.
        ASSERT_LE(now_J, energy_J * 1.01 + 1e-9) << mass_kg << " kg, " << k << " N/m, step " << i;
        energy_J = std::min(energy_J, now_J * 1.2 + 1e-12);
      }
      w.world->removeConstraint(&coupling);
    }
}

TEST_P(CouplingWithSolver, PressesWithTheForceOfItsSpring) {
  // A box on a fixed box, target below the surface: force on the ground = k x + weight.
  for (const double mass_kg : {1e-3, 0.05}) {
    World w{GetParam()};
    btBoxShape ground(btVector3(0.1, 0.1, 0.01));
    const test::Built part = test::build(makeBox(Vec3::Constant(0.02)), mass_kg / 8e-6, 0.5e-3, 2e-3);
    w.addShape(ground, 0, Vec3::Zero(), Pose::translation(Vec3(0, 0, -0.01)), 0.2);
    btRigidBody& body = w.add(part, Pose::translation(Vec3(0, 0, 0.01)));
    CouplingConstraint coupling(body, Pose(), gainsOf(20000, mass_kg));
    w.world->addConstraint(&coupling, true);
    coupling.setTarget(targetAt(Pose::translation(Vec3(0, 0, 0.01 - 5e-3))));  // 100 N
    w.step(200);
    EXPECT_NEAR(coupling.wrench().f.z(), -100, 1) << mass_kg;
    double normal_N = 0;
    for (int m = 0; m < w.dispatcher.getNumManifolds(); ++m)
      for (int i = 0; i < w.dispatcher.getManifoldByIndexInternal(m)->getNumContacts(); ++i)
        normal_N += w.dispatcher.getManifoldByIndexInternal(m)->getContactPoint(i).m_appliedImpulse / 1e-3;
    EXPECT_NEAR(normal_N, 100 + mass_kg * kGravity, 1) << mass_kg;
    EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.01, 1e-6) << mass_kg;
    w.world->removeConstraint(&coupling);
  }
}

TEST_P(CouplingWithSolver, LimitsTheSpringAndKeepsItsDirection) {
  btRigidBody& part = addBox(0.05);
  world.world->setGravity(btVector3(0, 0, 0));
  CouplingGains gains = gainsOf(2000, 0.05);
  gains.b_Ns_per_m = 0;
  gains.max_force_N = 5;
  CouplingConstraint coupling(part, Pose(), gains);
  world.world->addConstraint(&coupling, true);
  const Vec3 direction = Vec3(1, 2, -2) / 3;
  coupling.setTarget(targetAt(Pose::translation(0.1 * direction)));  // 200 N without a limit
  world.step();
  EXPECT_LE((coupling.wrench().f - 5 * direction).norm(), kIsDouble ? 1e-9 : 1e-5);
  // The part has the velocity that the coupling's force gives it.
  EXPECT_LE((fromBt(part.getLinearVelocity()) - 5 * direction / 0.05 * 1e-3).norm(),
            kIsDouble ? 1e-12 : 1e-7);
  world.world->removeConstraint(&coupling);
}

TEST_P(CouplingWithSolver, ReportsTheForceThatActedOnThePart) {
  // A light part, a stiff spring and an oblique lever: near some limits the spring's direction does not
  // converge within the solver's rounds. No other force acts, so the change of momentum is the coupling's
  // impulse.
  const double mass_kg = 1e-3, dt_s = 1e-3;
  for (double limit_N = 0.1; limit_N < 100; limit_N *= 1.1) {
    World w{GetParam()};
    w.world->setGravity(btVector3(0, 0, 0));
    const double I = mass_kg * 2 * 0.02 * 0.02 / 12;
    btRigidBody& part = w.addShape(box, mass_kg, Vec3::Constant(I), Pose());
    CouplingGains gains = gainsOf(20000, mass_kg);
    gains.b_Ns_per_m = 0;
    gains.max_force_N = limit_N;
    const Pose X_BG = Pose::translation(Vec3(0.01, 0.02, 0));
    CouplingConstraint coupling(part, X_BG, gains);
    w.world->addConstraint(&coupling, true);
    coupling.setTarget(targetAt(Pose::translation(Vec3(1e-3, 2e-3, 3e-3)) * X_BG));
    w.step();
    const Vec3 f = fromBt(part.getLinearVelocity()) * (mass_kg / dt_s);
    EXPECT_LE((coupling.wrench().f - f).norm(), (kIsDouble ? 1e-9 : 1e-4) * limit_N) << limit_N << " N";
    w.world->removeConstraint(&coupling);
  }
}

TEST_P(CouplingWithSolver, FollowsAKinematicProxy) {
  btRigidBody& part = addBox(0.05);
  btSphereShape ball(toBt(0.005));
  btRigidBody& proxy = world.addShape(ball, 0, Vec3::Zero(), Pose());
  proxy.setCollisionFlags(proxy.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  world.world->setGravity(btVector3(0, 0, 0));
  CouplingConstraint coupling(proxy, Pose(), part, Pose(), gainsOf(20000, 0.05));
  world.world->addConstraint(&coupling, true);
  btDefaultMotionState motion;
  proxy.setMotionState(&motion);
  for (int i = 1; i <= 500; ++i) {
    motion.m_graphicsWorldTrans.setOrigin(btVector3(toBt(1e-4 * i), 0, 0));  // 0.1 m/s
    world.world->stepSimulation(toBt(1e-3), 1, toBt(1e-3));
  }
  // Steady motion needs no force, and the target is that of the step's end: there is no lag.
  EXPECT_NEAR(part.getWorldTransform().getOrigin().x(), 0.05, 1e-6);
  proxy.setMotionState(nullptr);
  world.world->removeConstraint(&coupling);
}

TEST_P(CouplingWithSolver, GivesNoWrenchAfterRelease) {
  btRigidBody& part = addBox(0.05);
  CouplingConstraint coupling(part, Pose(), gainsOf(2000, 0.05));
  world.world->addConstraint(&coupling, true);
  coupling.setTarget(targetAt(Pose()));
  world.step(10);
  coupling.release();
  const double v0 = part.getLinearVelocity().z();
  world.step(10);
  EXPECT_EQ(coupling.wrench().f.norm(), 0);
  EXPECT_NEAR(part.getLinearVelocity().z(), v0 - kGravity * 0.01, 1e-6);
  world.world->removeConstraint(&coupling);
}

TEST_P(CouplingWithSolver, IgnoresATargetThatIsNotFinite) {
  btRigidBody& part = addBox(0.05);
  CouplingConstraint coupling(part, Pose(), gainsOf(2000, 0.05));
  world.world->addConstraint(&coupling, true);
  CouplingState target = targetAt(Pose());
  target.X_W.p.x() = std::nan("");
  coupling.setTarget(target);
  world.step(10);
  EXPECT_TRUE(std::isfinite(part.getWorldTransform().getOrigin().x()));
  EXPECT_EQ(coupling.wrench().f.norm(), 0);
  world.world->removeConstraint(&coupling);
}

INSTANTIATE_TEST_SUITE_P(Each, CouplingWithSolver,
                         testing::Values(SolverKind::Stock, SolverKind::Constraint, SolverKind::Penalty),
                         [](const auto& info) { return test::nameOf(info.param); });

// The coupling's pull moves the block's free path by 3 mm in a step of 1 ms, farther than a map's range.
TEST(Coupling, PullsAPartOntoAWallThatItWouldTunnelThroughInAStep) {
  for (const SolverKind solver : {SolverKind::Constraint, SolverKind::Penalty}) {
    World world(solver);
    const test::Built plate = test::plate(), box = test::steelBox();  // both are 10 mm thick
    world.add(plate, Pose::translation(Vec3(0, 0, -5e-3)), true);
    btRigidBody& part = world.add(box, Pose::translation(Vec3(0, 0, 6e-3)));
    CouplingGains gains = gainsOf(1e6, box.frame.mass_kg);
    gains.k_Nm_per_rad = 100;
    CouplingConstraint coupling(part, Pose(), gains);
    world.world->addConstraint(&coupling, true);
    coupling.setTarget(targetAt(Pose::translation(Vec3(0, 0, 3e-3))));
    world.step(200);
    // Penalty contact of 300 mm^2 and 1e12 N/m^3 yields to 2 kN by 6.7 um.
    EXPECT_NEAR(test::partPose(part, box).p.z(), 5e-3, solver == SolverKind::Penalty ? 10e-6 : 1e-6)
        << nameOf(solver);
    world.world->removeConstraint(&coupling);
  }
}

TEST(Coupling, RefusesASolverThatNeverCallsIt) {
  btDantzigSolver dantzig;
  btMLCPSolver mlcp(&dantzig);
  EXPECT_NE(CouplingConstraint::unsupportedReason(mlcp), nullptr);
  EXPECT_EQ(CouplingConstraint::unsupportedReason(Solver()), nullptr);
}

TEST(Coupling, RefusesBodiesAndGainsItCannotUse) {
  btSphereShape ball(1);
  btRigidBody fixed(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &ball));
  btRigidBody moving(btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &ball, btVector3(1, 1, 1)));
  EXPECT_THROW(CouplingConstraint(fixed, Pose(), CouplingGains()), std::invalid_argument);
  EXPECT_THROW(CouplingConstraint(moving, Pose(), moving, Pose(), CouplingGains()), std::invalid_argument);
  CouplingGains negative;
  negative.b_Ns_per_m = -1;
  EXPECT_THROW(CouplingConstraint(moving, Pose(), negative), std::invalid_argument);
}

}  // namespace
}  // namespace vps::bullet
