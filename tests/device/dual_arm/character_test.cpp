// SPDX-License-Identifier: BSD-3-Clause
// The device's own Table 1 against formulas, and against a search over all directions.
#include "vps_device/dual_arm/character.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "vps_device/dual_arm/controller.h"
#include "vps_device/dual_arm/plant.h"
#include "vps_device/gains.h"
#include "vps_device/random.h"

namespace vps::device {
namespace {

// The character is computed once, since the computation takes a second.
const DualArmCharacter& character() {
  static const DualArmCharacter c = characterise(DualArmParameters{});
  return c;
}

TEST(DualArmForces, WorstDirectionIsTheMinimumOverAllDirections) {
  const DualArmParameters p;
  const JointVector limits = motorLimits(p, 0);
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    const Pose X_DH{rotationFromVector(0.3 * random.normal3()), Vec3(0.1 * random.normal3())};
    EffortMap map;
    ASSERT_EQ(effortMap(p, X_DH, map), Status::Ok);
    for (const auto& efforts : {map.force, map.torque}) {
      const double least = leastOverDirections(efforts, map.weight, limits);
      double found = 1e9;
      for (int k = 0; k < 20000; ++k) {
        const Vec3 u = random.normal3().normalized();
        const double along = alongDirection(efforts, map.weight, limits, u);
        ASSERT_GE(along, least * (1 - 1e-12));
        found = std::min(found, along);
      }
      // Of 20000 directions one is within 0.05 rad of the worst direction; the cosine of this angle is 0.1%
      // off.
      EXPECT_LT(found, least * 1.002);
    }
  }
}

TEST(DualArmForces, MotorsGiveTheForceOfTheMapAndNoMore) {
  const DualArmParameters p;
  const JointVector limits = motorLimits(p, 1);
  EffortMap map;
  ASSERT_EQ(effortMap(p, Pose::translation(Vec3(0.1, 0.2, -0.1)), map), Status::Ok);
  const Vec3 u = Vec3(1, -2, 0.5).normalized();
  const double most_N = alongDirection(map.force, map.weight, limits, u);
  const JointVector efforts = map.weight + most_N * (map.force * u);
  EXPECT_NEAR((efforts.cwiseAbs() - limits).maxCoeff(), 0, 1e-12);
}

TEST(DualArmForces, StraightAheadOneArmLiftsItsTorqueDividedByItsLength) {
  const DualArmParameters p;
  const double lever_m = p.base_m - 0.5 * p.handle_m;
  const VerticalForce force = verticalForce(p, Vec3::Zero(), motorLimits(p, 0));
  EXPECT_NEAR(force.left_N, p.plate_torque_Nm / lever_m, 1e-12);
  EXPECT_NEAR(force.right_N, p.plate_torque_Nm / lever_m, 1e-12);
  EXPECT_NEAR(force.sum_N, 2 * p.plate_torque_Nm / lever_m - 9.81 * p.handle_kg, 1e-12);
  // The weight hangs 10 mm to the left of the midpoint: the left plate carries 11/20 of it.
  const double weight_N = 9.81 * p.handle_kg * (0.5 + 0.01 / p.handle_m);
  EXPECT_NEAR(force.both_N, 2 * (p.plate_torque_Nm / lever_m - weight_N), 1e-9);
}

TEST(DualArmForces, FigureFiveIsSymmetricExceptForTheMotorsWeight) {
  const std::vector<VerticalForceAt> all = verticalForces(DualArmParameters{});
  ASSERT_EQ(all.size(), 9u * 13 * 9);
  for (const VerticalForceAt& at : all) {
    const VerticalForce mirrored =
        verticalForce(DualArmParameters{}, Vec3(at.p_DE.x(), -at.p_DE.y(), at.p_DE.z()), motorLimits({}, 0));
    EXPECT_NEAR(at.force.left_N, mirrored.right_N, 1e-12);
    EXPECT_NEAR(at.force.sum_N, mirrored.sum_N, 1e-12);
    EXPECT_LE(at.force.both_N, at.force.sum_N + 1e-12);
  }
}

TEST(Characterise, TableOneIsMetWhereTheDeviceStatesIt) {
  const DualArmParameters p;
  const DualArmCharacter& c = character();
  EXPECT_GE(c.straight_scale, 1) << "the workspace is reached";
  EXPECT_NEAR(c.gimbal_sr, 12, 0.01);
  EXPECT_LE(c.centre_solid_angle_sr, c.gimbal_sr + 0.01);
  EXPECT_GT(c.up_N.continuous.least, 12);
  EXPECT_GT(c.left_up_N.continuous.least, 5);
  EXPECT_GE(c.straight_torque_Nm.continuous.least, 0.99);
  EXPECT_GE(c.straight_torque_Nm.peak.least, 2.48);
  EXPECT_GT(c.held_stiffness_N_per_m.least, 13.5e3);
  EXPECT_LT(c.held_stiffness_N_per_m.greatest, 18e3);
  EXPECT_LE(c.far_resolution_m.greatest, p.resolution_m);
  EXPECT_LE(c.far_resolution_rad.greatest, 0.005);
  EXPECT_GT(c.pair_isotropy, c.arm_isotropy);
  // The ends of the links are nearest: at the handle's length less the radii of two tubes.
  EXPECT_NEAR(c.tilted_clearance_m, p.handle_m - 2 * p.link_radius_m, 1e-12);
  EXPECT_LT(c.far_clearance_m, 0);
  EXPECT_EQ(c.gains_1kHz.k_N_per_m, characterise(p).gains_1kHz.k_N_per_m);
}

// coupling_stability_test.cpp verifies that these gains are passive and have no limit cycle.
TEST(Characterise, GainsAreDerivedFromTheArmsLimits) {
  const DualArmParameters p;
  const DualArmCharacter c = characterise(p);
  const DeviceLimits limits = dualArmLimits(p, 1000, true);
  EXPECT_EQ(c.gains_1kHz.k_N_per_m, deriveGains(limits, {1000, 1000, 0, 1, 1}).k_N_per_m);
  EXPECT_EQ(c.gains_4kHz.k_N_per_m,
            deriveGains(dualArmLimits(p, 4000, true), {4000, 1000, 0, 1, 1}).k_N_per_m);
  // Expected value: b of the arm, B = b / 5, a delay of T/2 + the arm's tick + a physics step = 2.5 ms, and
  // the margin of 0.8.
  const double b = limits.damping_Ns_per_m;
  EXPECT_NEAR(c.gains_1kHz.k_N_per_m, 0.8 * 0.8 * b / 2.5e-3, 1e-9);
  EXPECT_NEAR(c.gains_1kHz.b_Ns_per_m, 0.2 * b, 1e-12);
  // At 4 kHz friction and encoders limit the stiffness.
  EXPECT_NEAR(c.gains_4kHz.k_N_per_m,
              std::min(0.8 * 0.8 * b / 1.375e-3, 0.8 * 2 * limits.coulomb_N / limits.resolution_m), 1e-9);
}

TEST(Characterise, ASingleArmsFiguresFollowFromItsReach) {
  const DualArmParameters p;
  const DualArmCharacter& c = character();
  // Over the workspace the gimbal is between 0.45 m straight ahead of the base and the far edge, 1.05 m ahead
  // and 0.2 m aside.
  const double near_m = p.base_m - 0.5 * p.handle_m - 0.3, far_m = near_m + 0.6;
  EXPECT_NEAR(c.arm_manipulability_m2.least, near_m * near_m, 1e-9);  // d^2 cos t2, straight ahead
  const double most = std::hypot(far_m, std::hypot(0.2, 0.2)) * std::hypot(far_m, 0.2);
  EXPECT_NEAR(c.arm_manipulability_m2.greatest, most, 1e-9);
  EXPECT_NEAR(c.left_up_N.continuous.least, p.plate_torque_Nm / std::hypot(far_m, 0.2), 1e-9);
}

TEST(Characterise, NoReadingsErrorExceedsTheStatedResolution) {
  const DualArmCharacter& c = character();
  DualArmPlantSettings settings;
  settings.arms.noise_steps = 0;
  settings.is_rigid = true;
  DualArmPlant plant(settings);
  const DualArmParameters& p = settings.arms;
  Random random(2);
  double worst_m = 0, worst_rad = 0;
  for (int i = 0; i < 4000; ++i) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform(),
                 angle = 6.28 * random.uniform();
    const Mat3 R = rotationFromVector(0.785 * random.uniform() * Vec3(std::cos(angle), 0, std::sin(angle)));
    const Vec3 p_DE = p.workspace_m.cwiseProduct(Vec3(x - 0.5, y - 0.5, z - 0.5));
    const Pose X_DH(R, Vec3(p_DE + R * p.p_EH));
    plant.moveTo(X_DH);
    Pose X_read;
    ASSERT_EQ(handlePose(p, plant.read().joints, X_read), Status::Ok);
    worst_m = std::max(worst_m, (X_read.p - X_DH.p).norm());
    worst_rad = std::max(worst_rad, rotationVector(X_read.R * X_DH.R.transpose()).norm());
  }
  EXPECT_LE(worst_m, c.resolution_m.greatest *
                         1.01);  // between the grid's places the resolution may be a little coarser
  EXPECT_LE(worst_rad, c.resolution_rad.greatest * 1.01);
  EXPECT_GT(worst_m, 0.6 * c.resolution_m.greatest) << "the bound is much too wide";
}

}  // namespace
}  // namespace vps::device
