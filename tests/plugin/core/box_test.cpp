// SPDX-License-Identifier: BSD-3-Clause
#include "vps/box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "support/random_draw.h"
#include "vps/box_intersection.h"

namespace vps {
namespace {

Box drawnBox(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Box box;
  for (int i = 0; i < 2; ++i) box.add(test::drawnVector(normal, random));
  return box;
}

// Truth: the nearest point of a box is found by clamping; clamping alternately to two boxes converges to
// their nearest points.
TEST(Box, DistanceIsThatOfTheNearestPoints) {
  std::mt19937 random(1);
  int apart = 0;
  for (int i = 0; i < 1000; ++i) {
    const Box a = drawnBox(random), b = drawnBox(random);
    Vec3 p = a.center(), q = b.center();
    for (int k = 0; k < 8; ++k) {
      q = p.cwiseMax(b.min).cwiseMin(b.max);
      p = q.cwiseMax(a.min).cwiseMin(a.max);
    }
    ASSERT_NEAR(std::sqrt(distance2(a, b)), (p - q).norm(), 1e-12);
    ASSERT_EQ(distance2(a, b), distance2(b, a));
    ASSERT_EQ(distance2(a, b) == 0, overlap(a, b));
    apart += distance2(a, b) > 0 ? 1 : 0;
  }
  EXPECT_GT(apart, 300);
  EXPECT_LT(apart, 990);
  EXPECT_EQ(distance2(Box(), drawnBox(random)), std::numeric_limits<double>::infinity());
}

// A turned box lies in the box around it, so the distance to the latter is a lower bound.
TEST(Box, NoPointOfATurnedBoxIsNearerThanTheBoxAroundIt) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 300; ++i) {
    const Box a = drawnBox(random), b = drawnBox(random);
    const Pose X{test::drawnRotation(normal, random), 2 * test::drawnVector(normal, random)};
    const double least_m = std::sqrt(distance2(a, moved(b, X)));
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p = X * Vec3(corner & 1 ? b.max.x() : b.min.x(), corner & 2 ? b.max.y() : b.min.y(),
                              corner & 4 ? b.max.z() : b.min.z());
      ASSERT_LE(least_m, (p - p.cwiseMax(a.min).cwiseMin(a.max)).norm() + 1e-12);
    }
  }
}

// A point lies in the intersection exactly if it lies in both boxes.
TEST(Box, TheIntersectionHasThePointsOfBothBoxes) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  int empty = 0, within = 0;
  for (int i = 0; i < 1000; ++i) {
    const Box a = drawnBox(random), b = drawnBox(random), both = intersection(a, b);
    ASSERT_EQ(both.isEmpty(), !overlap(a, b));
    empty += both.isEmpty() ? 1 : 0;
    const Vec3 p = 0.5 * test::drawnVector(normal, random);
    ASSERT_EQ(isWithin(p, both), isWithin(p, a) && isWithin(p, b));
    within += isWithin(p, both) ? 1 : 0;
  }
  EXPECT_GT(empty, 300);
  EXPECT_LT(empty, 990);
  EXPECT_GT(within, 0);
  EXPECT_TRUE(intersection(Box(), drawnBox(random)).isEmpty());
}

}  // namespace
}  // namespace vps
