// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/placement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "vps_device/random.h"

namespace vps::device {
namespace {

const Pose kTruth(rotationFromVector(Vec3(0.4, -1.1, 2.0)), Vec3(0.3, -1.2, 0.8));

std::vector<TouchedPoint> touched(std::size_t count, double noise_m) {
  Random random(3);
  std::vector<TouchedPoint> points(count);
  for (TouchedPoint& point : points) {
    point.p_D = 0.2 * random.normal3();
    point.p_S = kTruth * point.p_D + noise_m * random.normal3();
  }
  return points;
}

TEST(Placement, OfExactPointsIsExact) {
  const Placement found = fitPlacement(touched(4, 0));
  ASSERT_EQ(found.status, Status::Ok);
  EXPECT_LT((found.X_SD.R - kTruth.R).norm() + (found.X_SD.p - kTruth.p).norm(), 1e-14);
  EXPECT_LT(found.greatest_m, 1e-15);
}

TEST(Placement, OfThreePointsIsARotationAndNoReflection) {
  const Placement found = fitPlacement(touched(3, 0));
  ASSERT_EQ(found.status, Status::Ok);
  EXPECT_NEAR(found.X_SD.R.determinant(), 1, 1e-14);
  EXPECT_LT((found.X_SD.R - kTruth.R).norm(), 1e-13);
}

TEST(Placement, OfNoisyPointsHasTheResidualOfTheNoise) {
  constexpr double kNoise_m = 1e-3;
  constexpr std::size_t kCount = 400;
  const Placement found = fitPlacement(touched(kCount, kNoise_m));
  ASSERT_EQ(found.status, Status::Ok);
  // Three coordinates a point, of which six numbers are fitted; the rms varies by 1 / sqrt(2 x 3 x 400).
  EXPECT_NEAR(found.rms_m, std::sqrt(3.0) * kNoise_m,
              4 * kNoise_m / std::sqrt(6.0 * kCount) * std::sqrt(3.0));
  // The position is a mean of all: four standard deviations of it.
  EXPECT_LT((found.X_SD.p - kTruth.p).norm(),
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
  for (int i = 0; i < 5; ++i) line.push_back({Vec3(0.1 * i, 0, 0), kTruth * Vec3(0.1 * i, 0, 0)});
  EXPECT_EQ(fitPlacement(line).status, Status::Singular);
  std::vector<TouchedPoint> bad = touched(4, 0);
  bad[1].p_D.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fitPlacement(bad).status, Status::BadPose);
}

}  // namespace
}  // namespace vps::device
