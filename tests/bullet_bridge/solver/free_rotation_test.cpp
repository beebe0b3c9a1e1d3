// SPDX-License-Identifier: BSD-3-Clause
// Rotation of a free body within a step, against conservation and against the exact turn about a principal
// axis.
#include "solver/island/island.h"

#include <LinearMath/btTransformUtil.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bullet_bridge/world.h"

namespace vps::bullet {
namespace {

const Vec3 kInertia(1, 2, 3.3);

// Bullet's turn, in double precision: beyond 45 degrees it limits the angle in sine and cosine, but not the
// length of the axis.
Mat3 turnOfBullet(const Vec3& w, double dt_s) {
  const double speed_rad_s = w.norm(), angle_rad = std::min(speed_rad_s * dt_s, std::numbers::pi / 4);
  const double half_rad = std::atan(speed_rad_s * dt_s * std::tan(angle_rad / 2) / angle_rad);
  return rotationFromVector(2 * half_rad * w.normalized());
}

TEST(FreeRotation, TheTurnOfBulletIsTheOneThatIsAssumed) {
  for (const double speed_rad_s : {20.0, 700.0, 900.0, 3000.0, 1e4}) {
    const Vec3 w = speed_rad_s * Vec3(-1, 0.1, 2).normalized();
    btTransform end;
    btTransformUtil::integrateTransform(btTransform::getIdentity(), btVector3(0, 0, 0), toBt(w),
                                        btScalar(1e-3), end);
    EXPECT_LE((fromBt(end).R - turnOfBullet(w, 1e-3)).norm(), test::kIsDouble ? 1e-13 : 1e-5) << speed_rad_s;
  }
}

// The velocity after a step, from the conserved momentum.
Vec3 after(const Vec3& w_B, const Vec3& mean, double dt_s) {
  return (turnOfBullet(mean, dt_s).transpose() * kInertia.cwiseProduct(w_B)).cwiseQuotient(kInertia);
}

TEST(FreeRotation, KeepsTheEnergyAtAnySpeed) {
  for (const double speed_rad_s : {1e-3, 1.0, 20.0, 300.0, 900.0, 1e4})
    for (const Vec3& axis : {Vec3(0.01, 1, 0.02), Vec3(1, 1, 1), Vec3(-1, 0.1, 2)}) {
      const Vec3 w = speed_rad_s * axis.normalized(),
                 end = after(w, meanAngularVelocity(kInertia, w, 1e-3), 1e-3);
      EXPECT_NEAR(end.dot(kInertia.cwiseProduct(end)) / w.dot(kInertia.cwiseProduct(w)), 1, 1e-13)
          << speed_rad_s;
    }
}

TEST(FreeRotation, ABodyThatSpinsAboutAPrincipalAxisTurnsAtItsOwnVelocity) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double speed_rad_s : {20.0, 700.0}) {
      const Vec3 w = speed_rad_s * Vec3::Unit(axis);
      EXPECT_LE((meanAngularVelocity(kInertia, w, 1e-3) - w).norm(), 1e-12 * speed_rad_s);
    }
}

TEST(FreeRotation, ABodyAtRestRestsExactly) {
  EXPECT_TRUE(meanAngularVelocity(kInertia, Vec3::Zero(), 1e-3).isZero(0));
}

TEST(FreeRotation, AVelocityThatIsNotFiniteIsReturned) {
  EXPECT_TRUE(std::isnan(meanAngularVelocity(kInertia, Vec3(0, std::nan(""), 0), 1e-3).y()));
}

// No body has these inertias, since one exceeds the sum of the others. The result must solve the equation or
// be the velocity itself.
TEST(FreeRotation, InertiasThatNoBodyHasGiveNoJump) {
  const double dt_s = 1e-2;
  for (const Vec3& J : {Vec3(1, 1e3, 1e-3), Vec3(1e-4, 1, 30), Vec3(1, 1e-6, 1e2)})
    for (const double speed_rad_s : {10.0, 70.0, 1000.0})
      for (const Vec3& axis : {Vec3(1, 1, 1), Vec3(1, 0.1, -2), Vec3(-0.2, 1, 0.7)}) {
        const Vec3 w = speed_rad_s * axis.normalized(), W = meanAngularVelocity(J, w, dt_s);
        const double angle_rad = std::min(W.norm() * dt_s, std::numbers::pi / 4);  // of sine and cosine
        const Vec3 L = J.cwiseProduct(w), JW = J.cwiseProduct(W),
                   rest = JW - L + dt_s * std::tan(angle_rad / 2) / angle_rad * W.cross(JW);
        EXPECT_TRUE(W == w || rest.norm() <= 1e-8 * L.norm()) << J.transpose() << " at " << w.transpose();
      }
}

// btCollisionObject::setWorldTransform() leaves Bullet's inertia tensor as it was.
TEST(FreeRotation, ABodyPlacedBySetWorldTransformKeepsItsSpin) {
  const test::Built box = test::build(makeBox(Vec3(20e-3, 30e-3, 60e-3)), 7850, 1e-3, 2e-3);
  for (const auto kind : {test::SolverKind::Constraint, test::SolverKind::Penalty}) {
    test::World world(kind);
    world.world->setGravity(btVector3(0, 0, 0));
    btRigidBody& body = world.add(box, Pose());
    btTransform to = body.getWorldTransform();
    const Mat3 R = rotationFromVector(Vec3(0.5, -1, 0.7)) * fromBt(to).R;
    to.setBasis(toBt(Pose(R, Vec3::Zero())).getBasis());
    body.setWorldTransform(to);
    body.setAngularVelocity(btVector3(5, 3, -2));
    const Vec3 J = fromBt(body.getInvInertiaDiagLocal()).cwiseInverse();
    const auto momentum = [&] {
      const Mat3 now = fromBt(body.getWorldTransform()).R;
      return Vec3(now * J.cwiseProduct(now.transpose() * fromBt(body.getAngularVelocity())));
    };
    const Vec3 start = momentum();
    for (int i = 0; i < 3; ++i) {
      world.step();
      EXPECT_LE((momentum() - start).norm(), (test::kIsDouble ? 1e-9 : 1e-5) * start.norm());
    }
  }
}

}  // namespace
}  // namespace vps::bullet
