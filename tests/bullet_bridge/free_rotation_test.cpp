// SPDX-License-Identifier: BSD-3-Clause
// Rotation of a free body within a step, against conservation and against the exact turn about a principal
// axis.
#include "solver/free_rotation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vps::bullet {
namespace {

const Vec3 kInertia(1, 2, 3.3);

// The velocity after a step, by the momentum.
Vec3 after(const Vec3& w_B, const Vec3& mean, double dt_s) {
  Vec3 turn = mean * dt_s;
  if (turn.norm() > std::numbers::pi / 4) turn *= std::numbers::pi / 4 / turn.norm();  // as Bullet
  return (rotationFromVector(turn).transpose() * kInertia.cwiseProduct(w_B)).cwiseQuotient(kInertia);
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

}  // namespace
}  // namespace vps::bullet
