// SPDX-License-Identifier: BSD-3-Clause
// The operator's sight: its error, its delay, and that it repeats with its seed.
#include "operator/sight.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vps::device {
namespace {

const Vec3 kTip_P(0, 0, -0.03);

/// Looks at a part that stands still for so long that `fixations` errors are drawn; gives the sums of
/// squares.
struct Errors {
  double square_m2 = 0, square_rad2 = 0;
};
Errors errorsOf(const OperatorHabits& habits, int fixations) {
  Sight sight(habits);
  sight.begin(kTip_P, 0);
  OperatorView view;
  view.X_WP = Pose(rotationFromVector(Vec3(0.3, 0.2, 0.1)), Vec3(1, 2, 3));
  Errors errors;
  for (int i = 1; i <= fixations; ++i) {
    // Once late in each fixation, when what is seen belongs to it.
    for (view.time_s = (i - 1) * habits.fixation_s; view.time_s < (i - 0.01) * habits.fixation_s;
         view.time_s += 1e-3)
      sight.look(view);
    errors.square_m2 += (sight.seen() * kTip_P - view.X_WP * kTip_P).squaredNorm();
    errors.square_rad2 += rotationVector(sight.seen().R * view.X_WP.R.transpose()).squaredNorm();
  }
  return errors;
}

TEST(Sight, ErrsAtTheTipByItsStandardDeviationInEachFixation) {
  const OperatorHabits habits;
  const int n = 1000;
  const Errors errors = errorsOf(habits, n);
  // The sum of 3 n squares has a relative deviation of sqrt(2 / 3n); four of them.
  const double share = 4 * std::sqrt(2.0 / (3 * n));
  EXPECT_NEAR(errors.square_m2 / (3 * n * habits.see_error_m * habits.see_error_m), 1, share);
  EXPECT_NEAR(errors.square_rad2 / (3 * n * habits.see_error_rad * habits.see_error_rad), 1, share);
}

TEST(Sight, IsLateByItsDelay) {
  OperatorHabits habits;
  habits.see_error_m = habits.see_error_rad = 0;
  Sight sight(habits);
  sight.begin(kTip_P, 0);
  OperatorView view;
  const double speed_m_s = 0.1;
  for (int i = 0; i < 1000; ++i) {
    view.time_s = 1e-3 * i;
    view.X_WP.p.x() = speed_m_s * view.time_s;
    sight.look(view);
  }
  // Pictures come at see_rate_hz, and the newest one may itself be one period old.
  const double late_s = view.time_s - sight.seen().p.x() / speed_m_s;
  EXPECT_GE(late_s, habits.see_delay_s);
  EXPECT_LE(late_s, habits.see_delay_s + 2 / habits.see_rate_hz + 2e-3);
}

TEST(Sight, SameSeedSameErrorsOtherSeedOthers) {
  OperatorHabits habits;
  const Errors first = errorsOf(habits, 5), again = errorsOf(habits, 5);
  EXPECT_EQ(first.square_m2, again.square_m2);
  habits.seed = 2;
  EXPECT_NE(first.square_m2, errorsOf(habits, 5).square_m2);
}

}  // namespace
}  // namespace vps::device
