// SPDX-License-Identifier: BSD-3-Clause
// Shapes with a formula for their signed distance (negative inside), the truth that tests compare with;
// random points; and the comparison of two voxmaps.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "support/random_draw.h"
#include "vps/mesh.h"
#include "vps/voxmap.h"

namespace vps::test {

inline double sphereDistance(const Vec3& p, double radius_m) {
  return p.norm() - radius_m;
}

/// Signed distance of a box of half sizes `half` around the origin.
inline double boxDistance(const Vec3& p, const Vec3& half) {
  const Vec3 past = p.cwiseAbs() - half;
  return past.cwiseMax(0.0).norm() + std::min(past.maxCoeff(), 0.0);
}

/// Signed distance of a solid of revolution around z whose profile is the rectangle r_low <= r <= r_high, |z|
/// <= half_z.
inline double ringDistance(const Vec3& p, double r_low, double r_high, double half_z) {
  const double r = std::hypot(p.x(), p.y());
  const double past_r = std::max(r - r_high, r_low - r), past_z = std::abs(p.z()) - half_z;
  return std::hypot(std::max(past_r, 0.0), std::max(past_z, 0.0)) + std::min(std::max(past_r, past_z), 0.0);
}
inline double tubeDistance(const Vec3& p, double outer_m, double inner_m, double height_m) {
  return ringDistance(p, inner_m, outer_m, height_m / 2);
}
inline double cylinderDistance(const Vec3& p, double radius_m, double height_m) {
  return ringDistance(p, -radius_m, radius_m, height_m / 2);
}

/// Distance of the flats of a polygon of `segments` sides from its circumscribed circle.
inline double sagitta(double radius_m, int segments) {
  return radius_m * (1 - std::cos(std::numbers::pi / segments));
}

/// Uniformly distributed random points in a box around the origin; the sequence depends only on the seed.
class RandomPoints {
 public:
  explicit RandomPoints(unsigned seed) : generator_(seed) {}
  Vec3 inBox(const Vec3& half) { return {half.x() * unit(), half.y() * unit(), half.z() * unit()}; }
  /// A number from -1 to 1.
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(generator_); }
  Pose pose(double reach_m) {
    const Quat q{unit(), unit(), unit(), unit()};  // within braces, arguments are evaluated in this order
    return {q, inBox(Vec3::Constant(reach_m))};
  }

 private:
  std::mt19937 generator_;
};

/// Expects equal readings, to the bit.
inline void expectSame(const VoxMap& a, const VoxMap& b) {
  EXPECT_EQ(a.voxel_m(), b.voxel_m());
  EXPECT_EQ(a.band_m(), b.band_m());
  EXPECT_EQ(a.brickCount(), b.brickCount());
  EXPECT_EQ(a.sampleError_m(), b.sampleError_m());
  EXPECT_EQ(a.bounds().min, b.bounds().min);
  EXPECT_EQ(a.bounds().max, b.bounds().max);
  RandomPoints random(16);
  for (int n = 0; n < 40000; ++n) {
    const Vec3 p = a.bounds().center() + random.inBox(a.bounds().size());
    ASSERT_EQ(a.distance(p), b.distance(p));
    ASSERT_EQ(a.lowerBound(p), b.lowerBound(p));
    ASSERT_EQ(a.leastDistance(p), b.leastDistance(p));
    ASSERT_EQ(a.isInsideCoarse(p), b.isInsideCoarse(p));
    ASSERT_EQ(a.normal(p), b.normal(p));
  }
}

}  // namespace vps::test
