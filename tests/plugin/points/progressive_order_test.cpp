// SPDX-License-Identifier: BSD-3-Clause
// The progressive order of shell points, compared with its definition point by point.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "pointshell/shell_hierarchy.h"

namespace vps {
namespace {

/// Checks that an order has its defined property: at each level with half the radius, a point joins if no
/// joined point is within the radius; points that remain after all levels are appended.
bool followsItsRule(const std::vector<Vec3>& points, const std::vector<std::uint32_t>& order) {
  Box box;
  for (const Vec3& p : points) box.add(p);
  double radius_m = box.size().norm();
  std::size_t joined = 0;
  for (int level = 0; level < 32; ++level, radius_m /= 2) {
    const auto isNear = [&](std::uint32_t i) {
      return std::any_of(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(joined),
                         [&](std::uint32_t j) { return (points[i] - points[j]).norm() <= radius_m; });
    };
    while (joined < order.size() && !isNear(order[joined])) ++joined;
    for (std::size_t k = joined; k < order.size(); ++k)
      if (!isNear(order[k])) return false;  // the point should have joined
  }
  return true;
}

// In the finest levels only few points have not joined yet, and the search grid keeps only the joined points
// near them.
TEST(ProgressiveOrder, FollowsItsRuleWithPointsThatAreNearlyOrExactlyTheSame) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> within(-1, 1);
  std::vector<Vec3> points;
  for (int i = 0; i < 400; ++i) points.emplace_back(within(random), within(random), 0.01 * within(random));
  for (int i = 0; i < 10; ++i) points.push_back(points[static_cast<std::size_t>(31 * i)]);
  for (int i = 0; i < 10; ++i)
    points.push_back(points[static_cast<std::size_t>(17 * i)] +
                     1e-6 * Vec3(within(random), within(random), 0));
  const std::vector<std::uint32_t> order = progressiveOrder(points);
  std::vector<std::uint32_t> sorted = order;
  std::ranges::sort(sorted);
  for (std::uint32_t i = 0; i < points.size(); ++i) ASSERT_EQ(sorted[i], i);
  EXPECT_TRUE(followsItsRule(points, order));
  std::vector<std::uint32_t> wrong = order;
  std::swap(wrong[5], wrong[300]);
  EXPECT_FALSE(followsItsRule(points, wrong));
}

}  // namespace
}  // namespace vps
