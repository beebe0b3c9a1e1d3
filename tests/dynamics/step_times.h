// SPDX-License-Identifier: BSD-3-Clause
// Processor time of simulation steps and of their share in the narrow phase and the solver.
#pragma once

#include <vector>

namespace vps::dynamics {

/// Processor time of this thread [s]: what other programs on the machine do costs a step nothing but cache.
double threadTime_s();

struct StepTimes {
  std::vector<double> step_s;
  double narrow_s = 0, solve_s = 0;  ///< summed over all steps

  [[nodiscard]] double mean_s() const;
  /// @param share  0 to 1: 0.5 the median, 0.99 the step that one in a hundred exceeds
  [[nodiscard]] double percentile_s(double share) const;
};

}  // namespace vps::dynamics
