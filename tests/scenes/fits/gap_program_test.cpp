// SPDX-License-Identifier: BSD-3-Clause
#include "motion/gap_program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/random_draw.h"

namespace vps::scenes {
namespace {

double leastAt(const std::vector<LinearGap>& gaps, const Eigen::Matrix<double, 6, 1>& x) {
  double least_m = 1e300;
  for (const LinearGap& gap : gaps) least_m = std::min(least_m, gap.at_zero_m + gap.slope_m.dot(x));
  return least_m;
}

LinearGap gapAlong(int axis, double at_zero_m, double slope_m) {
  LinearGap gap;
  gap.at_zero_m = at_zero_m;
  gap.slope_m[axis] = slope_m;
  return gap;
}

TEST(GapProgram, OppositeGapsBalance) {
  const GreatestGap found =
      greatestLeastGap(std::vector{gapAlong(0, -3e-6, 1e-3), gapAlong(0, -5e-6, -1e-3)});
  EXPECT_NEAR(found.most_m, -4e-6, 1e-15);
  EXPECT_NEAR(found.weight[0], 0.5, 1e-9);
}

TEST(GapProgram, OneGapThatOpensIsBoundedByItsRange) {
  EXPECT_NEAR(greatestLeastGap(std::vector{gapAlong(3, -1e-3, 2e-4)}).most_m, -8e-4, 1e-15);
}

// The bound is never below what some motion reaches, and a search by subgradients comes close to it.
TEST(GapProgram, TheBoundIsTheGreatestLeastGapOfRandomGaps) {
  test::Random draw(7);
  for (int k = 0; k < 40; ++k) {
    std::vector<LinearGap> gaps(5 + 7 * std::size_t(k));
    for (LinearGap& gap : gaps) {
      gap.at_zero_m = draw.uniform(-1e-5, 3e-6);
      for (double& slope : gap.slope_m) slope = draw.uniform(-1e-5, 1e-5);
    }
    const GreatestGap found = greatestLeastGap(gaps);
    Eigen::Matrix<double, 6, 1> x = Eigen::Matrix<double, 6, 1>::Zero();
    double best_m = leastAt(gaps, x);
    for (int i = 1; i < 20000; ++i) {
      const auto least = std::ranges::min_element(
          gaps, {}, [&](const LinearGap& gap) { return gap.at_zero_m + gap.slope_m.dot(x); });
      x += (1 / std::sqrt(i)) * least->slope_m.normalized();
      x = x.cwiseMax(-1).cwiseMin(1);
      best_m = std::max(best_m, leastAt(gaps, x));
    }
    EXPECT_GE(found.most_m, best_m - 1e-15) << k;
    EXPECT_LE(found.most_m, best_m + 3e-7) << k;
  }
}

}  // namespace
}  // namespace vps::scenes
