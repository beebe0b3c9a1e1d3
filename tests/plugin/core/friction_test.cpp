// SPDX-License-Identifier: BSD-3-Clause
#include "vps/friction.h"

#include <gtest/gtest.h>

namespace vps::test {
namespace {

TEST(Friction, TwoMaterialsHaveTheGeometricMeanOfTheirCoefficients) {
  EXPECT_DOUBLE_EQ(combinedFriction(0.1, 0.4), 0.2);
  EXPECT_DOUBLE_EQ(combinedFriction(0.15, 0.15), 0.15);
  EXPECT_EQ(combinedFriction(0, 0.5), 0);
}

TEST(Friction, TheConeShortensAnImpulseAndKeepsItsDirection) {
  double t1 = 3, t2 = -4;
  limitToCone(t1, t2, 2.5);
  EXPECT_DOUBLE_EQ(t1, 1.5);
  EXPECT_DOUBLE_EQ(t2, -2);
  limitToCone(t1, t2, 2.5);  // on the cone: unchanged
  EXPECT_DOUBLE_EQ(t1, 1.5);
  limitToCone(t1, t2, 0);
  EXPECT_EQ(t1, 0);
  EXPECT_EQ(t2, 0);
}

// A bristle of 1 kN/m bent by 2 mm would give 2 N.
TEST(Friction, ABristleSticksUpToItsLimitAndSlipsBeyond) {
  const Vec3 bend_m(0, 2e-3, 0);
  const BristleForce sticks = bristleForce(bend_m, 1e3, 2.001);
  EXPECT_DOUBLE_EQ(sticks.f_N.y(), 2);
  EXPECT_EQ(sticks.slip_m, 0);
  const BristleForce slips = bristleForce(bend_m, 1e3, 1.999);
  EXPECT_DOUBLE_EQ(slips.f_N.y(), 1.999);
  EXPECT_DOUBLE_EQ(slips.slip_m, 2e-3);
  EXPECT_EQ(slips.direction, Vec3(Vec3::UnitY()));
  EXPECT_EQ(bristleForce(bend_m, 1e3, 0).f_N, Vec3(Vec3::Zero()));
}

TEST(Friction, ADamperGivesTheLimitFromTheCreepSpeedOn) {
  EXPECT_DOUBLE_EQ(frictionDamping(3, 0.5, 1e-3) * 0.5, 3);
  EXPECT_DOUBLE_EQ(frictionDamping(3, 1e-4, 1e-3) * 1e-4, 0.3);
  EXPECT_DOUBLE_EQ(frictionDamping(3, 0, 1e-3) * 0, 0);
}

}  // namespace
}  // namespace vps::test
