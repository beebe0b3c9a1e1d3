// SPDX-License-Identifier: BSD-3-Clause
// Anderson's extrapolation, on maps whose fixed points are known.
#include "solver/fixed_point.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vps::bullet {
namespace {

using Eigen::VectorXd;

// Five slow directions, each with a factor of its own. After six pairs their changes cancel.
TEST(FixedPoint, OfALinearMapIsFoundFromAsManyPairsAsItHasDirections) {
  VectorXd factors(5), at(5);
  factors << 0.95, 0.9, 0.8, -0.7, 0.5;
  at << 1, -2, 3, 0.5, 4;
  const auto f = [&](const VectorXd& x) { return VectorXd(at + factors.cwiseProduct(x - at)); };
  FixedPoint point;
  VectorXd x = VectorXd::Zero(5), plain = x;
  for (int k = 0; k < 6; ++k) {
    x = point.next(x, f(x));
    plain = f(plain);
  }
  EXPECT_LE((x - at).norm(), 1e-8);
  EXPECT_GE((plain - at).norm(), 0.5);
}

TEST(FixedPoint, IsFoundWhereTheMapItselfRunsAway) {
  const auto f = [](const VectorXd& x) {
    return VectorXd(VectorXd::Ones(2) - 1.5 * x.array().sin().matrix());
  };
  FixedPoint point;
  VectorXd x = VectorXd::Zero(2);
  for (int k = 0; k < 12; ++k) x = point.next(x, f(x));
  EXPECT_LE((f(x) - x).norm(), 1e-9);
}

TEST(FixedPoint, StaysWhereNothingChanges) {
  FixedPoint point;
  const VectorXd x = VectorXd::Constant(3, 2.5);
  for (int k = 0; k < 10; ++k) EXPECT_EQ(point.next(x, x), x);
}

TEST(FixedPoint, StartsAnewWithAnotherSize) {
  FixedPoint point;
  for (const int size : {2, 7, 0, 3}) {
    point.clear();
    const VectorXd x = VectorXd::Ones(size), fx = 0.5 * x;
    EXPECT_EQ(point.next(x, fx), fx);
  }
}

}  // namespace
}  // namespace vps::bullet
