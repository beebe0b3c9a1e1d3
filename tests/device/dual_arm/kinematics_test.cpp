// SPDX-License-Identifier: BSD-3-Clause
// More than 400 lines: the tests of each equation share the helpers of this file.
#include "vps_device/dual_arm/kinematics.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "vps_device/random.h"

namespace vps::device {
namespace {

constexpr double kPi = std::numbers::pi;

Vec3 randomPlace(Random& random, const DualArmParameters& p) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return p.workspace_m.cwiseProduct(Vec3(x - 0.5, y - 0.5, z - 0.5));
}

// A handle anywhere in the workspace, rotated by up to `tilt_rad` about any axis.
Pose randomPose(Random& random, const DualArmParameters& p, double tilt_rad) {
  const Vec3 place = randomPlace(random, p), axis = random.normal3().normalized();
  return {rotationFromVector(tilt_rad * random.uniform() * axis), place};
}

double poseError(const Pose& a, const Pose& b) {
  return (a.p - b.p).norm() + (a.R - b.R).norm();
}

TEST(Arm, InverseFindsTheJointsOfEveryPosition) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const ArmJoints joints{2 * random.uniform() - 1, 2 * random.uniform() - 1, 0.4 + random.uniform()};
    ArmJoints found;
    ASSERT_EQ(armInverse(armPosition(joints), found), Status::Ok);
    // The bound is a dozen roundings of values of order 1.
    EXPECT_NEAR(found.t1_rad, joints.t1_rad, 1e-14);
    EXPECT_NEAR(found.t2_rad, joints.t2_rad, 1e-14);
    EXPECT_NEAR(found.d3_m, joints.d3_m, 1e-14);
  }
}

TEST(Arm, JacobiansAreTheDerivativesOfPositionAndPlate) {
  const ArmJoints j{0.3, -0.5, 0.9};
  const double h = 1e-6;  // central difference: error h^2 / 6 times a third derivative of order 1
  const Mat3 J = armJacobian(j);
  const auto d = [&](const ArmJoints& a, const ArmJoints& b) {
    return Vec3((armPosition(b) - armPosition(a)) / (2 * h));
  };
  EXPECT_LT((J.col(0) - d({j.t1_rad - h, j.t2_rad, j.d3_m}, {j.t1_rad + h, j.t2_rad, j.d3_m})).norm(), 1e-9);
  EXPECT_LT((J.col(1) - d({j.t1_rad, j.t2_rad - h, j.d3_m}, {j.t1_rad, j.t2_rad + h, j.d3_m})).norm(), 1e-9);
  EXPECT_LT((J.col(2) - d({j.t1_rad, j.t2_rad, j.d3_m - h}, {j.t1_rad, j.t2_rad, j.d3_m + h})).norm(), 1e-9);

  const DualArmParameters p;
  const Mat3 R_DA = armBase(p, Side::Left).R, J_w = R_DA * armAngularJacobian(j);
  const auto turn = [&](const ArmJoints& a, const ArmJoints& b) {
    return Vec3(rotationVector(barrelRotation(p, b) * barrelRotation(p, a).transpose()) / (2 * h));
  };
  // The rotation vector of a turn of 2e-6 keeps ten digits.
  EXPECT_LT((J_w.col(0) - turn({j.t1_rad - h, j.t2_rad, 1}, {j.t1_rad + h, j.t2_rad, 1})).norm(), 1e-8);
  EXPECT_LT((J_w.col(1) - turn({j.t1_rad, j.t2_rad - h, 1}, {j.t1_rad, j.t2_rad + h, 1})).norm(), 1e-8);
}

TEST(Arm, IsSingularOnItsVerticalAxis) {
  ArmJoints joints;
  EXPECT_EQ(armInverse(Vec3(0, 0, 0.5), joints), Status::Singular);
  EXPECT_EQ(armInverse(Vec3::Zero(), joints), Status::Singular);
  EXPECT_EQ(armInverse(Vec3(NAN, 0, 1), joints), Status::BadPose);
}

TEST(Gimbal, MatrixIsARotation) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 q = 2 * random.normal3();
    const Mat3 R = gimbalRotation(q.x(), q.y(), q.z());
    EXPECT_NEAR(R.determinant(), 1, 1e-14);
    EXPECT_LT((R.transpose() * R - Mat3::Identity()).norm(), 1e-14);
  }
}

TEST(Gimbal, AnglesAreRecoveredInTheWholePlane) {
  for (int i = -17; i <= 18; ++i) {
    for (int k = -8; k <= 8; ++k) {
      const double q1 = i * kPi / 18, q2 = k * kPi / 18;
      double found1 = 0, found2 = 0;
      ASSERT_EQ(gimbalAngles(gimbalRotation(q1, q2, 0.7).col(1), found1, found2), Status::Ok);
      EXPECT_NEAR(std::remainder(found1 - q1, 2 * kPi), 0, 1e-14) << "q1 " << q1 << " q2 " << q2;
      EXPECT_NEAR(found2, q2, 1e-14);
    }
  }
  double q1 = 0, q2 = 0;
  EXPECT_EQ(gimbalAngles(Vec3::UnitZ(), q1, q2), Status::Singular);
}

TEST(Handle, LiesStraightAtTheOriginWithAllAnglesZero) {
  const DualArmParameters p;
  DualArmJoints joints;
  ASSERT_EQ(handleJoints(p, Pose::translation(p.p_EH), joints), Status::Ok);
  const double reach_m = p.base_m - 0.5 * p.handle_m;
  for (const ArmJoints& arm : {joints.left, joints.right}) {
    EXPECT_NEAR(arm.t1_rad, 0, 1e-15);
    EXPECT_NEAR(arm.t2_rad, 0, 1e-15);
    EXPECT_NEAR(arm.d3_m, reach_m, 1e-15);
  }
  EXPECT_NEAR(joints.q3_rad, 0, 1e-15);
}

TEST(Handle, ForwardUndoesInverseOverTheWorkspace) {
  const DualArmParameters p;
  Random random(3);
  double worst = 0;
  for (int i = 0; i < 5000; ++i) {
    const Pose X_DH = randomPose(random, p, 1.2);
    DualArmJoints joints;
    ASSERT_EQ(handleJoints(p, X_DH, joints), Status::Ok);
    Pose X_back;
    ASSERT_EQ(handlePose(p, joints, X_back), Status::Ok);
    worst = std::max(worst, poseError(X_back, X_DH));
  }
  EXPECT_LE(worst, 1e-12);  // roundings, times 1 / L and 1 / cos q2
}

// A grid over the whole workspace, its faces and corners too, with every handle direction within the gimbal's
// range and every turn of the handle about itself within the motor's.
template <typename Visit>
int overTheWorkspace(const DualArmParameters& p, const Visit& visit) {
  int visited = 0;
  for (int place = 0; place < 5 * 7 * 5; ++place) {
    const Vec3 at(place % 5 / 4.0 - 0.5, place / 5 % 7 / 6.0 - 0.5, place / 35 / 4.0 - 0.5);
    const Vec3 p_DH = p.workspace_m.cwiseProduct(at);
    for (int direction = 0; direction < 26; ++direction) {
      // Faces, edges and corners of a cube, turned a little so that none lies in a singular plane by chance.
      const int code = direction < 13 ? direction : direction + 1;
      const Vec3 Y = Vec3(code % 3 - 1 + 0.01, code / 3 % 3 - 1 + 0.02, code / 9 - 1 - 0.015).normalized();
      const Mat3 R_straight = Quat::FromTwoVectors(Vec3::UnitY(), Y).normalized().toRotationMatrix();
      for (const double spin_rad : {-2.4, -1.1, 0.0, 1.3, 2.5}) {
        const Pose X_DH(Mat3(R_straight * rotationFromVector(Vec3(0, spin_rad, 0))), p_DH);
        HandleMotion motion;
        if (handleMotion(p, X_DH, motion) != Status::Ok || std::abs(motion.q2_rad) > p.q2_max_rad) continue;
        ++visited;
        visit(X_DH, motion);
      }
    }
  }
  return visited;
}

TEST(Handle, ForwardUndoesInverseOverTheWholeWorkspaceAndAllDirections) {
  for (const bool is_calibrated : {false, true}) {
    DualArmParameters p;
    if (is_calibrated) {
      p.right_shift_m = Vec3(3e-3, -2e-3, 1e-3);
      p.right_turn_rad = Vec3(0.01, -0.02, 0.015);
    }
    double worst_m = 0, worst_rad = 0, worst_joint = 0;
    const int visited = overTheWorkspace(p, [&](const Pose& X_DH, const HandleMotion& motion) {
      Pose X_back;
      DualArmJoints joints;
      ASSERT_EQ(handlePose(p, fromVector(motion.joints), X_back), Status::Ok);
      ASSERT_EQ(handleJoints(p, X_back, joints), Status::Ok);
      worst_m = std::max(worst_m, (X_back.p - X_DH.p).norm());
      worst_rad = std::max(worst_rad, (X_back.R - X_DH.R).norm());
      worst_joint = std::max(worst_joint, (toVector(joints) - motion.joints).cwiseAbs().maxCoeff());
    });
    EXPECT_GT(visited, 15000);
    RecordProperty("worst_m", std::to_string(1e15 * worst_m) + "e-15");
    // The required accuracy is 1e-9 m and 1e-9 rad. Roundings of 1e-16 times 1 / L and 1 / cos q2 (3.4 at its
    // limit) give 1e-13.
    EXPECT_LE(worst_m, 1e-13);
    EXPECT_LE(worst_rad, 1e-13);
    EXPECT_LE(worst_joint, 1e-13);
  }
}

TEST(Handle, GimbalAngleFollowsItsRate) {
  const DualArmParameters p;
  Random random(12);
  const double h = 1e-6;
  for (int i = 0; i < 200; ++i) {
    const Pose X_DH = randomPose(random, p, 1.0);
    const Twist V{random.normal3(), random.normal3()};
    const auto moved = [&](double t) {
      return Pose(Mat3(rotationFromVector(t * V.w) * X_DH.R), Vec3(X_DH.p + t * V.v));
    };
    HandleMotion motion, a, b;
    ASSERT_EQ(handleMotion(p, X_DH, motion), Status::Ok);
    ASSERT_EQ(handleMotion(p, moved(-h), a), Status::Ok);
    ASSERT_EQ(handleMotion(p, moved(h), b), Status::Ok);
    Eigen::Matrix<double, 6, 1> twist;
    twist << V.w, V.v;
    // h^2 times third derivatives up to 1e3 near the gimbal's limit, plus 1e-16 / h.
    EXPECT_NEAR(motion.J_q2.dot(twist), (b.q2_rad - a.q2_rad) / (2 * h), 1e-8);
  }
}

TEST(Handle, SingularAnglesAndJointLimitsAreDetected) {
  const DualArmParameters p;
  // Along the barrel's z3 the gimbal locks: D's x with the left arm straight ahead.
  HandleMotion motion;
  const Pose X_DL = armBase(p, Side::Left);
  const Pose locked(rotationFromVector(Vec3(0, 0, -kPi / 2)), Vec3(0.5 * p.handle_m, 0, 0));
  const Pose X_locked = locked * Pose::translation(p.p_EH);
  EXPECT_EQ(handleMotion(p, X_locked, motion), Status::Singular);
  // A pose just within each joint's limit is reachable, and a pose just beyond the limit is not.
  const auto isReached = [&](int joint, double value) {
    DualArmJoints joints;
    EXPECT_EQ(handleJoints(p, Pose::translation(p.p_EH), joints), Status::Ok);
    JointVector values = toVector(joints);
    values[joint] = value;
    // Only the left arm's joints can be chosen; the right arm follows the handle.
    const Vec3 p_L = X_DL * armPosition(fromVector(values).left);
    const Vec3 p_DE = p_L + Vec3(0, 0.5 * p.handle_m, 0);
    return isReachable(p, Pose::translation(p_DE + p.p_EH));
  };
  EXPECT_TRUE(isReached(1, 0.99 * p.plate_max_rad));
  EXPECT_FALSE(isReached(1, 1.01 * p.plate_max_rad));
  EXPECT_TRUE(isReached(0, -0.99 * p.plate_max_rad));
  EXPECT_FALSE(isReached(0, -1.01 * p.plate_max_rad));
  EXPECT_TRUE(isReached(2, 1.01 * p.reach_min_m));
  EXPECT_FALSE(isReached(2, 0.99 * p.reach_min_m));
  const auto spun = [&](double rad) { return Pose(rotationFromVector(Vec3(0, rad, 0)), Vec3::Zero()); };
  EXPECT_TRUE(isReachable(p, spun(0.99 * p.q3_max_rad)));
  EXPECT_FALSE(isReachable(p, spun(1.01 * p.q3_max_rad)));
}

TEST(Statics, PowerAndWrenchHoldToOneBillionthOverTheWholeWorkspace) {
  const DualArmParameters p;
  Random random(13);
  double worst_power = 0, worst_wrench = 0;
  overTheWorkspace(p, [&](const Pose& X_DH, const HandleMotion& motion) {
    const Wrench F{random.normal3(), 10 * random.normal3()};
    Eigen::Matrix<double, 6, 1> twist, wrench;
    twist << random.normal3(), random.normal3();
    wrench << F.tau, F.f;
    JointVector efforts;
    Wrench back;
    ASSERT_EQ(motorEfforts(p, X_DH, F, efforts), Status::Ok);
    ASSERT_EQ(handleWrench(p, X_DH, efforts, back), Status::Ok);
    // Relative to the sum of the magnitudes of all powers, since the powers may cancel.
    const JointVector powers = efforts.cwiseProduct(motion.J * twist);
    worst_power = std::max(worst_power, std::abs(powers.sum() - wrench.dot(twist)) / powers.cwiseAbs().sum());
    worst_wrench =
        std::max(worst_wrench, (back.f - F.f).norm() / F.f.norm() + (back.tau - F.tau).norm() / F.tau.norm());
  });
  RecordProperty("worst_power", std::to_string(1e15 * worst_power) + "e-15");
  RecordProperty("worst_wrench", std::to_string(1e15 * worst_wrench) + "e-15");
  // Required is 1e-9. Ten roundings of 1e-16 times 1 / L and 1 / cos q2 give 1e-13.
  EXPECT_LE(worst_power, 1e-13);
  EXPECT_LE(worst_wrench, 1e-13);
  EXPECT_GT(worst_wrench, 0) << "no wrench was compared";
}

TEST(Handle, WholeWorkspaceIsReachableWithTheHandleTurnedBy45Degrees) {
  const DualArmParameters p;
  Random random(4);
  for (int i = 0; i < 5000; ++i) {
    const Pose X_DH = randomPose(random, p, kPi / 4);
    EXPECT_TRUE(isReachable(p, X_DH)) << X_DH.p.transpose();
  }
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sign((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
    EXPECT_TRUE(isReachable(p, Pose::translation(0.5 * p.workspace_m.cwiseProduct(sign))));
  }
  EXPECT_FALSE(isReachable(p, Pose::translation(Vec3(0, 0.7, 0))));
}

TEST(Handle, ArmsDoNotCollideWithTheHandleUpTo70DegreesFromStraight) {
  const DualArmParameters p;
  Random random(5);
  double least_m = 1;
  for (int i = 0; i < 20000; ++i) {
    DualArmJoints joints;
    ASSERT_EQ(handleJoints(p, randomPose(random, p, 70 * kPi / 180), joints), Status::Ok);
    least_m = std::min(least_m, armClearance_m(p, joints));
  }
  EXPECT_GT(least_m, 0.02);
  // With the handle turned end for end the arms cross.
  DualArmJoints joints;
  ASSERT_EQ(handleJoints(p, Pose(rotationFromVector(Vec3(0, 0, kPi - 0.01)), Vec3::Zero()), joints),
            Status::Ok);
  EXPECT_LT(armClearance_m(p, joints), 0);
}

TEST(Handle, GimbalAllowsTwelveSteradiansOfDirections) {
  const DualArmParameters p;
  EXPECT_NEAR(4 * kPi * std::sin(p.q2_max_rad), 12, 0.01);  // Table 1 of the paper: about 12
}

TEST(Handle, JacobianIsTheDerivativeOfTheJoints) {
  const DualArmParameters p;
  Random random(6);
  const double h = 1e-6;
  for (int i = 0; i < 200; ++i) {
    const Pose X_DH = randomPose(random, p, 1.0);
    const Twist V{random.normal3(), random.normal3()};
    JointMatrix J;
    ASSERT_EQ(handleJacobian(p, X_DH, J), Status::Ok);
    const auto moved = [&](double t) {
      return Pose(Mat3(rotationFromVector(t * V.w) * X_DH.R), Vec3(X_DH.p + t * V.v));
    };
    DualArmJoints a, b;
    ASSERT_EQ(handleJoints(p, moved(-h), a), Status::Ok);
    ASSERT_EQ(handleJoints(p, moved(h), b), Status::Ok);
    JointVector difference;
    difference << b.left.t1_rad - a.left.t1_rad, b.left.t2_rad - a.left.t2_rad, b.left.d3_m - a.left.d3_m,
        b.right.t1_rad - a.right.t1_rad, b.right.t2_rad - a.right.t2_rad, b.right.d3_m - a.right.d3_m,
        b.q3_rad - a.q3_rad;
    Eigen::Matrix<double, 6, 1> twist;
    twist << V.w, V.v;
    // h^2 times third derivatives up to 1e3 near the gimbal's limit, plus 1e-16 / h.
    EXPECT_LT((J * twist - difference / (2 * h)).norm(), 1e-8);
  }
}

TEST(Statics, MotorPowerIsHandlePower) {
  const DualArmParameters p;
  Random random(7);
  for (int i = 0; i < 2000; ++i) {
    const Pose X_DH = randomPose(random, p, 1.2);
    const Wrench F{random.normal3(), 10 * random.normal3()};
    const Twist V{random.normal3(), random.normal3()};
    JointVector efforts;
    JointMatrix J;
    ASSERT_EQ(motorEfforts(p, X_DH, F, efforts), Status::Ok);
    ASSERT_EQ(handleJacobian(p, X_DH, J), Status::Ok);
    Eigen::Matrix<double, 6, 1> twist;
    twist << V.w, V.v;
    EXPECT_NEAR(efforts.dot(J * twist), power(F, V), 1e-9);  // powers are of order 10 W, so 10 digits
  }
}

TEST(Statics, WrenchIsRecoveredFromMotorEfforts) {
  const DualArmParameters p;
  Random random(8);
  for (int i = 0; i < 2000; ++i) {
    const Pose X_DH = randomPose(random, p, 1.2);
    const Wrench F{random.normal3(), 10 * random.normal3()};
    JointVector efforts;
    Wrench back;
    ASSERT_EQ(motorEfforts(p, X_DH, F, efforts), Status::Ok);
    ASSERT_EQ(handleWrench(p, X_DH, efforts, back), Status::Ok);
    EXPECT_LT((back.f - F.f).norm() + (back.tau - F.tau).norm(), 1e-11);
  }
}

// One function uses the balance of forces and the other uses power, so that they share no formula.
TEST(Statics, AnyEffortsGiveTheWrenchOfTheJacobian) {
  const DualArmParameters p;
  Random random(9);
  for (int i = 0; i < 1000; ++i) {
    const Pose X_DH = randomPose(random, p, 1.2);
    JointVector efforts;
    for (int k = 0; k < 7; ++k) efforts[k] = random.normal();
    JointMatrix J;
    Wrench F;
    ASSERT_EQ(handleJacobian(p, X_DH, J), Status::Ok);
    ASSERT_EQ(handleWrench(p, X_DH, efforts, F), Status::Ok);
    Eigen::Matrix<double, 6, 1> stacked;
    stacked << F.tau, F.f;
    EXPECT_LT((J.transpose() * efforts - stacked).norm(), 1e-10);
  }
}

TEST(Statics, CoupleAcrossTheHandleNeedsOppositeForcesOfTorqueOverLength) {
  const DualArmParameters p;
  JointVector efforts;
  // 1 N m about x at the origin pushes the right end (at +y) up and the left one down, with 1 / L = 5 N each.
  ASSERT_EQ(motorEfforts(p, Pose::translation(p.p_EH), {Vec3(1, 0, 0), Vec3::Zero()}, efforts), Status::Ok);
  const double torque_Nm = (p.base_m - 0.5 * p.handle_m) / p.handle_m;
  EXPECT_NEAR(efforts[4], torque_Nm, 1e-12);
  EXPECT_NEAR(efforts[1], -torque_Nm, 1e-12);
}

TEST(Statics, CoupleAlongATiltedHandleLoadsTheArmsToo) {
  const DualArmParameters p;
  Pose X_DH(rotationFromVector(Vec3(0, 0, 0.6)), Vec3::Zero());  // q2 is not zero
  JointVector efforts;
  ASSERT_EQ(motorEfforts(p, X_DH, {Vec3(X_DH.R.col(1)), Vec3::Zero()}, efforts), Status::Ok);
  EXPECT_NEAR(efforts[6], 1, 1e-12);
  EXPECT_GT(efforts.head<6>().norm(), 0.1);
}

TEST(Statics, TableOneForceIsReachedThroughoutTheWorkspace) {
  const DualArmParameters p;
  Random random(10);
  const JointVector limit = motorLimits(p, 0);
  double least_up_N = 1e9;
  for (int i = 0; i < 5000; ++i) {
    const Pose X_DH = Pose::translation(randomPlace(random, p));
    JointVector efforts;
    const Vec3 p_HE = -p.p_EH;  // figure 5 is of the gimbals' midpoint
    ASSERT_EQ(motorEfforts(p, X_DH, {p_HE.cross(Vec3(0, 0, 1)), Vec3(0, 0, 1)}, efforts), Status::Ok);
    least_up_N = std::min(least_up_N, (limit.array() / efforts.array().abs().max(1e-12)).minCoeff());
  }
  // Section 3 of the paper: the pair of arms pushes upward with at least 12 N while it carries the handle's
  // weight.
  EXPECT_GT(least_up_N - 9.81 * p.handle_kg, 12);
  EXPECT_GT(p.plate_torque_Nm / p.reach_max_m, 5);  // the force of one arm alone, at worst
  EXPECT_LT(p.plate_torque_Nm / p.reach_max_m, 6);
}

TEST(Statics, SaturationKeepsTheDirection) {
  const DualArmParameters p;
  Random random(11);
  const JointVector limit = motorLimits(p, 1);
  for (int i = 0; i < 1000; ++i) {
    const Pose X_DH = randomPose(random, p, 1.0);
    const Wrench F{5 * random.normal3(), 60 * random.normal3()}, weight{Vec3::Zero(), Vec3(0, 0, 1.962)};
    JointVector wish, bias;
    ASSERT_EQ(motorEfforts(p, X_DH, F, wish), Status::Ok);
    ASSERT_EQ(motorEfforts(p, X_DH, weight, bias), Status::Ok);
    const double scale = saturationScale(bias, wish, limit);
    const JointVector efforts = bias + scale * wish;
    EXPECT_LE((efforts.cwiseAbs() - limit).maxCoeff(), 1e-12);
    if (scale < 1) {
      EXPECT_NEAR((efforts.cwiseAbs() - limit).maxCoeff(), 0, 1e-12) << "a greater wrench was possible";
    }
    Wrench back;
    ASSERT_EQ(handleWrench(p, X_DH, efforts, back), Status::Ok);
    EXPECT_LT((back.f - weight.f - scale * F.f).norm(), 1e-10);
    EXPECT_LT((back.tau - scale * F.tau).norm(), 1e-10);
  }
}

TEST(Statics, SingularAndNonFinitePosesGiveNoEfforts) {
  const DualArmParameters p;
  JointVector efforts;
  // The handle along the barrel's z3, which is D's x here: the gimbal locks.
  const Pose locked(rotationFromVector(Vec3(0, 0, -kPi / 2)), Vec3::Zero());
  const Pose X_DL = armBase(p, Side::Left);
  const Pose through_axis = Pose::translation(X_DL.p + Vec3(0, 0.5 * p.handle_m, 0) + p.p_EH);
  EXPECT_EQ(motorEfforts(p, through_axis, {Vec3::UnitX(), Vec3::UnitX()}, efforts), Status::Singular);
  EXPECT_EQ(efforts, JointVector(JointVector::Zero()));
  EXPECT_EQ(motorEfforts(p, Pose::translation(Vec3(NAN, 0, 0)), {}, efforts), Status::BadPose);
  EXPECT_EQ(motorEfforts(p, Pose{}, {Vec3(INFINITY, 0, 0), Vec3::Zero()}, efforts), Status::BadPose);
  EXPECT_FALSE(isReachable(p, locked));
}

}  // namespace
}  // namespace vps::device
