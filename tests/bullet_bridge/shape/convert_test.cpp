// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/convert.h"

#include <gtest/gtest.h>

namespace vps::bullet {
namespace {

// One rounding to btScalar each way.
constexpr double kRounding = sizeof(btScalar) == 8 ? 1e-15 : 1e-7;

const Pose kPose(Quat(0.5, -0.1, 0.7, 0.3), Vec3(0.1, -0.02, 0.003));

TEST(Convert, VectorsPassThereAndBack) {
  const Vec3 v(1.5, -2.25, 1e-3);
  EXPECT_LE((fromBt(toBt(v)) - v).norm(), 3 * kRounding);
}

TEST(Convert, QuaternionsKeepTheOrderOfTheirComponents) {
  const Quat q = kPose.quaternion();
  EXPECT_NEAR(toBt(q).w(), q.w(), kRounding);
  EXPECT_LE((fromBt(toBt(q)).coeffs() - q.coeffs()).norm(), 3 * kRounding);
}

TEST(Convert, PosesPassThereAndBack) {
  const Pose back = fromBt(toBt(kPose));
  EXPECT_LE((back.R - kPose.R).norm(), 9 * kRounding);
  EXPECT_LE((back.p - kPose.p).norm(), 3 * kRounding);
}

TEST(Convert, BothMapAPointToTheSamePlace) {
  const Vec3 p(0.01, 0.02, -0.03);
  EXPECT_LE((fromBt(toBt(kPose) * toBt(p)) - kPose * p).norm(), 10 * kRounding);
}

TEST(Convert, RotationsByQuaternionAndByMatrixAgree) {
  const btMatrix3x3 by_matrix = toBt(kPose).getBasis();
  const btMatrix3x3 by_quaternion(toBt(kPose.quaternion()));
  EXPECT_LE((fromBt(by_matrix) - fromBt(by_quaternion)).norm(), 20 * kRounding);
}

}  // namespace
}  // namespace vps::bullet
