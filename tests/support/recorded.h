// SPDX-License-Identifier: BSD-3-Clause
// A recorded run, and the comparison of two runs to the bit.
#pragma once

#include <gtest/gtest.h>

#include "vps_device/recording.h"
#include "vps_scenes/run/result.h"

namespace vps::test {

struct Recorded {
  scenes::AssembleResult result;
  device::RecordedRun run;
};

inline void expectSame(const scenes::AssembleResult& a, const scenes::AssembleResult& b) {
  EXPECT_EQ(a.completed, b.completed);
  EXPECT_EQ(a.haptic.count, b.haptic.count);
  EXPECT_EQ(a.simulated_s, b.simulated_s);
  EXPECT_EQ(a.energy.to_hand_J, b.energy.to_hand_J);
  EXPECT_EQ(a.energy.from_hand_J, b.energy.from_hand_J);
  EXPECT_EQ(a.energy.injected_J, b.energy.injected_J);
  ASSERT_EQ(a.steps.size(), b.steps.size());
  for (std::size_t i = 0; i < a.steps.size(); ++i) {
    EXPECT_EQ(a.steps[i].failure_reason, b.steps[i].failure_reason);
    EXPECT_EQ(a.steps[i].max_penetration_m, b.steps[i].max_penetration_m);
    EXPECT_EQ(a.steps[i].peak_force_N, b.steps[i].peak_force_N);
    EXPECT_EQ(a.steps[i].final_error_m, b.steps[i].final_error_m);
    EXPECT_EQ(a.steps[i].rest_drift_m, b.steps[i].rest_drift_m);
    EXPECT_EQ(a.steps[i].late_drift_m, b.steps[i].late_drift_m);
  }
  ASSERT_EQ(a.trace.size(), b.trace.size());
  for (std::size_t i = 0; i < a.trace.size(); ++i) {
    ASSERT_EQ(a.trace[i].X_WP.p, b.trace[i].X_WP.p) << i;
    ASSERT_EQ(a.trace[i].X_WP.R, b.trace[i].X_WP.R) << i;
    ASSERT_EQ(a.trace[i].F_hand_W.f, b.trace[i].F_hand_W.f) << i;
    ASSERT_EQ(a.trace[i].phase, b.trace[i].phase) << i;
  }
}

}  // namespace vps::test
