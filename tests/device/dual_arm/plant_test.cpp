// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/dual_arm/plant.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "support/no_alloc.h"
#include "vps_device/dual_arm/statics.h"

namespace vps::device {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr double kPlantStep_s = 1e-3;

DualArmPlantSettings frictionless() {
  DualArmPlantSettings s;
  s.has_quantised_encoders = false;
  s.arms.plate_damping_Nms = s.arms.link_damping_Ns_per_m = s.arms.rotor_damping_Nms = 0;
  s.arms.plate_coulomb_Nm = s.arms.link_coulomb_N = s.arms.rotor_coulomb_Nm = 0;
  return s;
}

JointVector carryOf(const DualArmParameters& p, const Pose& X_DH) {
  JointVector efforts;
  EXPECT_EQ(motorEfforts(p, X_DH, {Vec3::Zero(), Vec3(0, 0, 9.81 * p.handle_kg)}, efforts), Status::Ok);
  return efforts;
}

HandForce pushing(const Vec3& f) {
  HandForce hand;
  hand.F.f = f;
  return hand;
}

TEST(DualArmPlant, WithFixedMotorsTheHandleYieldsByTheStructureAlone) {
  DualArmPlantSettings settings;
  settings.has_quantised_encoders = false;
  // Motors that cannot turn.
  settings.arms.plate_coulomb_Nm = settings.arms.link_coulomb_N = settings.arms.rotor_coulomb_Nm = 1e4;
  const DualArmParameters& p = settings.arms;
  double softest = 1e9, stiffest = 0;
  for (int i = 0; i < 27; ++i) {
    const Vec3 corner(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    settings.X_DH_start = Pose::translation(0.5 * p.workspace_m.cwiseProduct(corner));
    const JointVector carry = carryOf(p, settings.X_DH_start);
    HandleMotion motion;
    ASSERT_EQ(handleMotion(p, settings.X_DH_start, motion), Status::Ok);
    const Mat6 K = motion.J.transpose() * structureStiffness(p, motion.joints).asDiagonal() * motion.J;
    for (const bool is_held :
         {false, true}) {  // by a hand that lets the handle rotate, and by a hand that does not
      HandForce hand;
      hand.X_eq = settings.X_DH_start;
      if (is_held) hand.k_Nm_per_rad = 1e6 * Mat3::Identity();
      Mat6 K_all = K;
      K_all.topLeftCorner<3, 3>() += hand.k_Nm_per_rad;
      for (int axis = 0; axis < 3; ++axis) {
        DualArmPlant plant(settings);
        hand.F.f = 5 * Vec3::Unit(axis);
        for (int tick = 0; tick < 400; ++tick) {
          plant.drive(carry);
          plant.step(kPlantStep_s, hand);
        }
        Vec6 F;
        F << Vec3::Zero(), hand.F.f;
        const Vec3 expected = K_all.ldlt().solve(F).tail<3>(), moved = plant.pose().p - settings.X_DH_start.p;
        // The structure is linear for 0.4 mm of 0.45 m; dry friction below its slip speed creeps for 0.4 s,
        // 1e4 N m at 2e-3 rad/s.
        EXPECT_LT((moved - expected).norm(), 0.01 * moved.norm()) << i << " " << axis;
        if (!is_held) continue;
        softest = std::min(softest, 5 / moved[axis]);
        stiffest = std::max(stiffest, 5 / moved[axis]);
      }
    }
  }
  RecordProperty("softest_N_per_m", std::to_string(softest));
  RecordProperty("stiffest_N_per_m", std::to_string(stiffest));
  // Table 1 of the paper: 14 to 18 N/mm, along the axes at the workspace's centre, faces, edges and corners.
  EXPECT_GT(softest, 14000);
  EXPECT_LT(stiffest, 18000);
}

TEST(DualArmStructure, StiffnessIsCapstanLinkAndGimbalInSeriesAndDriftIsTheGradientOfItsEnergy) {
  const DualArmParameters p;
  JointVector q;
  q << 0.2, -0.5, 0.7, -0.1, 0.4, 1.1, 0.3;
  const JointVector k = structureStiffness(p, q);
  const double lever_m = 0.7 * std::cos(-0.5);
  EXPECT_NEAR(1 / k[0], 1 / p.plate_Nm_per_rad + 1 / (p.gimbal_N_per_m * lever_m * lever_m), 1e-15);
  EXPECT_NEAR(1 / k[4], 1 / p.plate_Nm_per_rad + 1 / (p.gimbal_N_per_m * 1.1 * 1.1), 1e-15);
  EXPECT_NEAR(1 / k[5], 1 / p.link_N_per_m + 1 / p.gimbal_N_per_m, 1e-15);
  EXPECT_EQ(k[6], p.rotor_Nm_per_rad);
  const JointVector stretch = jointVector(1e-3, 2e-3, 0.1);
  const auto energy_J = [&](const JointVector& at) {
    return 0.5 * stretch.cwiseAbs2().dot(structureStiffness(p, at));
  };
  const JointVector drift = structureDrift(p, q, stretch);
  const double h = 1e-5;  // central: h^2 times third derivatives of some 1e-2 J, and 1e-16 J / h
  for (int i = 0; i < 7; ++i) {
    const JointVector step = h * JointVector::Unit(i);
    EXPECT_NEAR(drift[i], -(energy_J(q + step) - energy_J(q - step)) / (2 * h), 1e-10) << i;
  }
  EXPECT_GT(drift.norm(), 1e-4);
}

TEST(DualArmPlant, AcceleratesByItsInertia) {
  DualArmPlantSettings settings = frictionless();
  settings.is_rigid = true;
  settings.arms.delay_ticks = 0;
  const DualArmParameters& p = settings.arms;
  settings.X_DH_start = Pose(rotationFromVector(Vec3(0.3, 0.1, -0.4)), Vec3(0.1, -0.2, 0.1));
  DualArmPlant plant(settings);
  HandleMotion motion;
  ASSERT_EQ(handleMotion(p, settings.X_DH_start, motion), Status::Ok);
  const JointVector inertia = jointVector(p.plate_kgm2, p.link_kg, p.rotor_kgm2);
  Mat6 M = motion.J.transpose() * inertia.asDiagonal() * motion.J;
  const Mat3& R = settings.X_DH_start.R;
  M.topLeftCorner<3, 3>() += R * p.handle_kgm2.asDiagonal() * R.transpose();
  M.bottomRightCorner<3, 3>().diagonal().array() += p.handle_kg;
  plant.drive(carryOf(p, settings.X_DH_start));
  HandForce hand = pushing(Vec3(1, -2, 0.5));
  hand.F.tau = Vec3(0.01, -0.02, 0.015);
  plant.step(1e-6, hand);
  Vec6 F, V;
  F << hand.F.tau, hand.F.f;
  V << plant.twist().w, plant.twist().v;
  EXPECT_LT((V / 1e-6 - M.llt().solve(F)).norm(), 1e-6 * (M.llt().solve(F)).norm());
}

TEST(DualArmPlant, CommandActsAfterTheStatedTicks) {
  for (const int delay : {0, 1, 3, 8}) {
    DualArmPlantSettings settings;
    settings.arms.delay_ticks = delay;
    DualArmPlant plant(settings);
    const JointVector before = plant.efforts(), wanted = jointVector(1, 2, 0.5);
    for (int tick = 0; tick < 12; ++tick) {
      plant.drive(wanted);
      EXPECT_EQ(plant.efforts(), tick < delay ? before : wanted) << delay << " " << tick;
      plant.step(kPlantStep_s, {});
    }
  }
}

TEST(DualArmPlant, AmplifiersSwitchOffWithoutCommandsAndLimitEfforts) {
  DualArmPlant plant;
  const DualArmParameters& p = plant.settings().arms;
  JointVector wild = JointVector::Constant(1e9);
  wild[3] = NAN;
  plant.drive(wild);
  plant.drive(wild);
  JointVector expected = motorLimits(p, 1);
  expected[3] = 0;
  EXPECT_EQ(plant.efforts(), expected);
  const int ticks = static_cast<int>(p.watchdog_s / kPlantStep_s);
  HandForce hand;
  hand.b_Ns_per_m = 1e3 * Mat3::Identity();
  for (int i = 0; i < ticks; ++i) plant.step(kPlantStep_s, hand);
  EXPECT_EQ(plant.efforts(), expected);
  for (int i = 0; i < 3; ++i) plant.step(kPlantStep_s, hand);
  EXPECT_EQ(plant.efforts(), JointVector(JointVector::Zero()));
}

TEST(DualArmPlant, StopsHoldEachJointAndReturnNoEnergy) {
  DualArmPlantSettings settings = frictionless();
  const DualArmParameters& p = settings.arms;
  // A hand pulls the handle far along each axis with at most 15 N, and about each axis with 1 N m.
  for (int axis = 0; axis < 12; ++axis) {
    DualArmPlant plant(settings);
    const double sign = axis % 2 == 0 ? 1 : -1;
    const Vec3 pull = sign * Vec3::Unit(axis / 2 % 3);
    const bool is_turn = axis >= 6;
    double gained_J = 0, travelled_J = 0;
    bool has_hit = false;
    for (int tick = 0; tick < 3000; ++tick) {
      HandForce hand;
      (is_turn ? hand.F.tau : hand.F.f) = (is_turn ? 0.5 : 15.0) * pull;
      // The hand damps; its own work is accounted for, and the remaining energy must balance.
      hand.b_Ns_per_m = 30 * Mat3::Identity();
      hand.b_Nms_per_rad = 0.2 * Mat3::Identity();
      plant.drive(carryOf(p, plant.pose()));
      plant.step(kPlantStep_s, hand);
      HandleMotion motion;
      ASSERT_EQ(handleMotion(p, plant.pose(), motion), Status::Ok) << axis;
      for (int i = 0; i < 8; ++i) {
        const bool is_slide = i == 2 || i == 5;
        const double value = i < 7 ? motion.joints[i] : motion.q2_rad;
        const double most = is_slide ? p.reach_max_m
                            : i == 6 ? p.q3_max_rad
                            : i == 7 ? p.q2_max_rad
                                     : p.plate_max_rad;
        const double least = is_slide ? p.reach_min_m : -most;
        const double beyond = std::max(value - most, least - value);
        has_hit = has_hit || beyond > 0;
        // Slides: 15 N and the kinetic energy of the run-up act on a stop of 20 kN/m. Plates and gimbal: 15 N
        // at a lever arm of up to 1.35 m act on a stop of 2 kN m/rad, and 0.5 N m on a stop of 20 N m/rad;
        // the run-up adds the same amount.
        const double allowed = is_slide ? 5e-3 : i < 6 ? 0.05 : 0.15;
        EXPECT_LT(beyond, allowed) << "axis " << axis << " joint " << i;
      }
      travelled_J += kPlantStep_s * power(plant.lastHandWrench(), plant.twist());
      gained_J = std::max(gained_J, plant.kinetic_J() + plant.structure_J() - travelled_J);
    }
    // About x the handle turns end for end: no joint stop limits this rotation, since the arms would collide
    // first.
    EXPECT_EQ(has_hit, axis / 2 != 3) << axis;
    EXPECT_LT(gained_J, 2e-3)
        << "axis " << axis;  // weight and its compensation differ by the structure's deflection of 0.2 mm
  }
}

TEST(DualArmPlant, NoiseHasTheStatedDeviationAndDependsOnlyOnTheSeed) {
  DualArmPlantSettings settings;
  settings.arms.noise_steps = 5;  // well above the rounding's 0.29 steps
  DualArmPlant plant(settings), same(settings);
  settings.seed = 2;
  DualArmPlant other(settings);
  const DualArmParameters& p = settings.arms;
  HandleMotion motion;
  ASSERT_EQ(handleMotion(p, plant.pose(), motion), Status::Ok);
  const JointVector step = jointVector(p.plate_step_rad, p.link_step_m, p.rotor_step_rad);
  JointVector sum = JointVector::Zero(), squares = JointVector::Zero();
  constexpr int kReads = 4000;
  bool is_other = false;
  JointVector first;
  for (int i = 0; i < kReads; ++i) {
    const JointVector values = toVector(plant.read().joints);
    ASSERT_EQ(values, toVector(same.read().joints));
    is_other = is_other || values != toVector(other.read().joints);
    if (i == 0) first = values;
    const JointVector e = (values - first).cwiseQuotient(step);
    sum += e;
    squares += e.cwiseAbs2();
  }
  EXPECT_TRUE(is_other);
  for (int i = 0; i < 7; ++i) {
    const double mean = sum[i] / kReads, deviation = std::sqrt(squares[i] / kReads - mean * mean);
    // The variance is 5^2 plus the rounding's 1/12; the tolerance is four standard deviations of an estimate
    // from 4000 reads, 4 / sqrt(8000).
    EXPECT_NEAR(deviation, std::sqrt(25 + 1 / 12.0), 0.045 * 5) << i;
  }
}

TEST(DualArmPlant, OscillatesOnItsStructureAtTheFrequencyOfItsInertia) {
  DualArmPlantSettings settings = frictionless();
  settings.arms.structure_damping_s = 0;
  settings.arms.handle_kg = 1e-6;  // no weight: only structure and inertia
  settings.arms.gimbal_N_per_m = 1e9;
  settings.arms.p_EH.setZero();
  // The motors are held by their inertia, a thousand times that of the links.
  settings.arms.plate_kgm2 = 50;
  settings.arms.motor_share = 0.99;
  const DualArmParameters& p = settings.arms;
  DualArmPlant plant(settings);
  // A short push upward; the two plates swing together, each with its own link's inertia on its own spring.
  const double dt_s = 2e-5;
  plant.drive(JointVector::Zero());
  int crossings = 0;
  double last = 0, first_s = 0, last_s = 0;
  for (int i = 0; i < 20000; ++i) {
    plant.drive(JointVector::Zero());
    plant.step(dt_s, pushing(i < 10 ? Vec3(0, 0, 50) : Vec3(0, 0, 0)));
    HandleMotion motion;
    ASSERT_EQ(handleMotion(p, plant.pose(), motion), Status::Ok);
    const double v = plant.twist().v.z();
    if (i > 20 && last < 0 && v >= 0) {
      ++crossings;
      last_s = plant.time_s();
      if (crossings == 1) first_s = last_s;
    }
    last = v;
  }
  ASSERT_GT(crossings, 5);
  const double found_hz = (crossings - 1) / (last_s - first_s);
  // Reduced inertia: 1% on the link's side against 99% on the motor's. Euler's step shifts the frequency by
  // (w dt)^2 / 3, which is 1e-5.
  const double link = 0.01 * p.plate_kgm2, motor = 0.99 * p.plate_kgm2,
               reduced = link * motor / (link + motor);
  const double expected_hz = std::sqrt(p.plate_Nm_per_rad / reduced) / (2 * M_PI);
  EXPECT_NEAR(found_hz, expected_hz, 0.01 * expected_hz);
}

TEST(DualArmPlant, MotorsNeverHeatBeyondTheirContinuousRating) {
  DualArmParameters p;
  p.thermal_s = 0.5;
  MotorHeat heat(p);
  double hottest = 0, peak_s = 0;
  for (int i = 0; i < 20000; ++i) {
    const JointVector efforts = heat.limits();  // the efforts are always at the present limit
    if (efforts[0] > 0.99 * p.plate_peak_Nm) peak_s = i * kPlantStep_s;
    heat.add(efforts, kPlantStep_s);
    hottest = std::max(hottest, heat.heat().maxCoeff());
  }
  EXPECT_LT(hottest, 1 + 1e-9);
  EXPECT_GT(hottest, 0.99) << "the motor could give more";
  // A cold motor gives its peak for t with 1 - exp(-t / tau) = 0.9 (c / p)^2.
  const double ratio = p.plate_torque_Nm / p.plate_peak_Nm;
  EXPECT_NEAR(peak_s, -p.thermal_s * std::log(1 - 0.9 * ratio * ratio), 3e-3);
}

TEST(DualArmPlant, StepsWithoutAllocating) {
  DualArmPlant plant;
  const vps_test::NoAllocScope guard;
  for (int i = 0; i < 100; ++i) {
    plant.read();
    plant.drive(jointVector(1, 1, 0.1));
    plant.step(kPlantStep_s, pushing(Vec3(1, 2, 3)));
  }
}

}  // namespace
}  // namespace vps::device
