// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/no_alloc.h"
#include "vps_device/random.h"

namespace vps::device {
namespace {

const Pose kPlacement(rotationFromVector(Vec3(0.4, -1.1, 2.0)), Vec3(0.3, -1.2, 0.8));

std::vector<TouchedPoint> touched(std::size_t count, double noise_m) {
  Random random(3);
  std::vector<TouchedPoint> points(count);
  for (TouchedPoint& point : points) {
    point.p_D = 0.2 * random.normal3();
    point.p_S = kPlacement * point.p_D + noise_m * random.normal3();
  }
  return points;
}

TEST(Placement, OfExactPointsIsExact) {
  const Placement found = fitPlacement(touched(4, 0));
  ASSERT_EQ(found.status, Status::Ok);
  EXPECT_LT((found.X_SD.R - kPlacement.R).norm() + (found.X_SD.p - kPlacement.p).norm(), 1e-14);
  EXPECT_LT(found.greatest_m, 1e-15);
}

TEST(Placement, OfThreePointsIsARotationAndNoReflection) {
  const Placement found = fitPlacement(touched(3, 0));
  ASSERT_EQ(found.status, Status::Ok);
  EXPECT_NEAR(found.X_SD.R.determinant(), 1, 1e-14);
  EXPECT_LT((found.X_SD.R - kPlacement.R).norm(), 1e-13);
}

TEST(Placement, OfNoisyPointsHasTheResidualOfTheNoise) {
  constexpr double kNoise_m = 1e-3;
  constexpr std::size_t kCount = 400;
  const Placement found = fitPlacement(touched(kCount, kNoise_m));
  ASSERT_EQ(found.status, Status::Ok);
  // Each point has three coordinates, and six numbers are fitted; the rms varies by 1 / sqrt(2 x 3 x 400).
  EXPECT_NEAR(found.rms_m, std::sqrt(3.0) * kNoise_m,
              4 * kNoise_m / std::sqrt(6.0 * kCount) * std::sqrt(3.0));
  // The position is a mean over all points: the bound is four standard deviations of the mean.
  EXPECT_LT((found.X_SD.p - kPlacement.p).norm(),
            4 * std::sqrt(3.0) * kNoise_m / std::sqrt(double(kCount)) * 1.5);
}

TEST(Placement, NamesTheWorstPoint) {
  std::vector<TouchedPoint> points = touched(10, 0);
  points[7].p_S.x() += 0.05;
  const Placement found = fitPlacement(points);
  EXPECT_EQ(found.worst, 7u);
  EXPECT_GT(found.greatest_m, 2 * found.rms_m);
}

TEST(Placement, OfTooLittleIsRefused) {
  EXPECT_EQ(fitPlacement(touched(2, 0)).status, Status::Truncated);
  std::vector<TouchedPoint> line;
  for (int i = 0; i < 5; ++i) line.push_back({Vec3(0.1 * i, 0, 0), kPlacement * Vec3(0.1 * i, 0, 0)});
  EXPECT_EQ(fitPlacement(line).status, Status::Singular);
  std::vector<TouchedPoint> bad = touched(4, 0);
  bad[1].p_D.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fitPlacement(bad).status, Status::BadPose);
}

// A device whose right base is a few millimetres and a degree off its nominal pose.
DualArmParameters displaced() {
  DualArmParameters p;
  p.right_shift_m = Vec3(3e-3, -2e-3, 1.5e-3);
  p.right_turn_rad = Vec3(0.01, -0.015, 0.02);
  return p;
}

// Readings of the encoders at random poses of the handle. noise_steps: standard deviation, in encoder steps.
std::vector<DualArmJoints> readingsOf(const DualArmParameters& truth, int count, double tilt_rad,
                                      double noise_steps, std::uint64_t seed) {
  Random random(seed);
  std::vector<DualArmJoints> readings;
  const JointVector step = jointVector(truth.plate_step_rad, truth.link_step_m, truth.rotor_step_rad);
  while (static_cast<int>(readings.size()) < count) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    const Pose X_DH(rotationFromVector(tilt_rad * random.uniform() * random.normal3().normalized()),
                    Vec3(truth.workspace_m.cwiseProduct(Vec3(x - 0.5, y - 0.5, z - 0.5))));
    DualArmJoints joints;
    if (handleJoints(truth, X_DH, joints) != Status::Ok) continue;
    JointVector values = toVector(joints);
    for (int i = 0; i < 7; ++i) values[i] += noise_steps * step[i] * random.normal();
    readings.push_back(fromVector(values));
  }
  return readings;
}

double errorOf_m(const DualArmParameters& found, const DualArmParameters& truth) {
  return (armBase(found, Side::Right).p - armBase(truth, Side::Right).p).norm();
}
double errorOf_rad(const DualArmParameters& found, const DualArmParameters& truth) {
  return rotationVector(armBase(found, Side::Right).R * armBase(truth, Side::Right).R.transpose()).norm();
}

TEST(BaseCalibration, FindsTheBaseFromExactReadingsToRounding) {
  const DualArmParameters truth = displaced();
  const BaseCalibration found = calibrateBases(DualArmParameters{}, readingsOf(truth, 60, 1.0, 0, 1));
  ASSERT_EQ(found.status, Status::Ok);
  // Roundings of 1e-16 m, times the least squares' condition (below 1e3 for these poses).
  EXPECT_LT(errorOf_m(found.parameters, truth), 1e-12);
  EXPECT_LT(errorOf_rad(found.parameters, truth), 1e-12);
  EXPECT_LT(found.rms_m, 1e-14);
  EXPECT_LT(found.iterations, 12);
}

TEST(BaseCalibration, ConvergesFromFiveCentimetresAndTenDegreesOff) {
  DualArmParameters truth;
  truth.right_shift_m = Vec3(0.03, -0.03, 0.03);
  truth.right_turn_rad = Vec3(0.1, 0.1, -0.1);
  const BaseCalibration found = calibrateBases(DualArmParameters{}, readingsOf(truth, 60, 1.0, 0, 2));
  ASSERT_EQ(found.status, Status::Ok);
  EXPECT_LT(errorOf_m(found.parameters, truth), 1e-12);
}

TEST(BaseCalibration, WithNoiseItsErrorMatchesTheStatedDeviation) {
  const DualArmParameters truth = displaced();
  double mean_square_m = 0, mean_square_rad = 0;
  constexpr int kRuns = 40;
  for (int run = 0; run < kRuns; ++run) {
    // Rounding to a step is noise of 0.29 steps; 0.5 is more than the noise of the encoders.
    const BaseCalibration found =
        calibrateBases(DualArmParameters{}, readingsOf(truth, 200, 1.0, 0.5, 10 + run));
    ASSERT_EQ(found.status, Status::Ok);
    EXPECT_GT(found.sigma_m, 0);
    const double share_m = errorOf_m(found.parameters, truth) / found.sigma_m;
    const double share_rad = errorOf_rad(found.parameters, truth) / found.sigma_rad;
    // Each of three directions has at most one standard deviation, so their root sum of squares exceeds 5 in
    // one of 1e5 runs (chi square of three).
    EXPECT_LT(share_m, 5);
    EXPECT_LT(share_rad, 5);
    mean_square_m += share_m * share_m / kRuns;
    mean_square_rad += share_rad * share_rad / kRuns;
  }
  // The mean square lies between one direction's and three directions' variance; 40 runs scatter it by a
  // quarter.
  EXPECT_GT(mean_square_m, 0.6);
  EXPECT_LT(mean_square_m, 3.8);
  EXPECT_GT(mean_square_rad, 0.6);
  EXPECT_LT(mean_square_rad, 3.8);
}

TEST(BaseCalibration, CorrectsTheReadingsOfTheRealEncoders) {
  const DualArmParameters truth = displaced();
  const BaseCalibration found = calibrateBases(DualArmParameters{}, readingsOf(truth, 200, 1.0, 0.3, 7));
  ASSERT_EQ(found.status, Status::Ok);
  double before_m = 0, after_m = 0;
  for (const DualArmJoints& joints : readingsOf(truth, 300, 0.8, 0, 99)) {
    Pose X_true, X_before, X_after;
    ASSERT_EQ(handlePose(truth, joints, X_true), Status::Ok);
    ASSERT_EQ(handlePose(DualArmParameters{}, joints, X_before), Status::Ok);
    ASSERT_EQ(handlePose(found.parameters, joints, X_after), Status::Ok);
    before_m = std::max(before_m, (X_before.p - X_true.p).norm());
    after_m = std::max(after_m, (X_after.p - X_true.p).norm());
  }
  RecordProperty("before_um", std::to_string(1e6 * before_m));
  RecordProperty("after_um", std::to_string(1e6 * after_m));
  EXPECT_GT(before_m, 5e-3) << "nothing to calibrate";
  EXPECT_LT(after_m, truth.resolution_m / 2);  // the remaining error is below the encoders' resolution
}

TEST(BaseCalibration, ReportsWhyItCannotSolve) {
  const DualArmParameters p;
  EXPECT_EQ(calibrateBases(p, readingsOf(p, 11, 1.0, 0, 3)).status, Status::Truncated);
  // Without rotations the handle measures in one direction only.
  EXPECT_EQ(calibrateBases(p, readingsOf(p, 100, 0, 0, 4)).status, Status::Singular);
  std::vector<DualArmJoints> bad = readingsOf(p, 20, 1.0, 0, 5);
  bad[7].right.d3_m = NAN;
  const BaseCalibration found = calibrateBases(p, bad);
  EXPECT_EQ(found.status, Status::BadPose);
  EXPECT_EQ(found.parameters.right_shift_m, p.right_shift_m);
}

TEST(BaseCalibration, NeverAllocates) {
  const DualArmParameters p;
  const std::vector<DualArmJoints> readings = readingsOf(displaced(), 60, 1.0, 0.3, 6);
  const vps_test::NoAllocScope guard;
  EXPECT_EQ(calibrateBases(p, readings).status, Status::Ok);
}

TEST(DeviceFrames, ThreeFramesAgreeOnPositionsPowersAndTheArmsReadings) {
  const DualArmParameters p = displaced();
  const Pose X_DH(rotationFromVector(Vec3(0.3, -0.2, 0.5)), Vec3(0.1, -0.2, 0.05));
  const Twist V_D{Vec3(1, 2, 3), Vec3(-0.1, 0.2, 0.3)};
  const Wrench F_D{Vec3(0.1, 0.2, -0.3), Vec3(4, 5, 6)};
  for (const DeviceFrame frame : {DeviceFrame::Independent, DeviceFrame::Left, DeviceFrame::Right}) {
    const Pose X = inFrame(p, X_DH, DeviceFrame::Independent, frame);
    const Pose back = inFrame(p, X, frame, DeviceFrame::Independent);
    EXPECT_LT((back.p - X_DH.p).norm() + (back.R - X_DH.R).norm(), 1e-14) << toText(frame);
    EXPECT_NEAR(power(inFrame(p, F_D, DeviceFrame::Independent, frame),
                      inFrame(p, V_D, DeviceFrame::Independent, frame)),
                power(F_D, V_D), 1e-13);
  }
  // An arm alone reads the position of its gimbal centre in its own frame.
  DualArmJoints joints;
  ASSERT_EQ(handleJoints(p, X_DH, joints), Status::Ok);
  const Vec3 p_HE = -p.p_EH, half = Vec3(0, 0.5 * p.handle_m, 0);
  const Pose X_left = inFrame(p, X_DH, DeviceFrame::Independent, DeviceFrame::Left);
  const Pose X_right = inFrame(p, X_DH, DeviceFrame::Independent, DeviceFrame::Right);
  EXPECT_LT((X_left * Vec3(p_HE - half) - armPosition(joints.left)).norm(), 1e-15 * 10);
  EXPECT_LT((X_right * Vec3(p_HE + half) - armPosition(joints.right)).norm(), 1e-15 * 10);
}

}  // namespace
}  // namespace vps::device
