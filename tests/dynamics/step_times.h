// SPDX-License-Identifier: BSD-3-Clause
// Processor time of simulation steps and of their share in the narrow phase and the solver.
#pragma once

#include <vector>

namespace vps::dynamics {

/// Processor time of this thread [s]; other programs on the machine affect it only through the caches.
double threadTime_s();

struct StepTimes {
  std::vector<double> step_s;
  double narrow_s = 0, solve_s = 0;  ///< summed over all steps

  [[nodiscard]] double mean_s() const;
  /// @param share  0 to 1: 0.5 the median, 0.99 the time that one step in a hundred exceeds
  [[nodiscard]] double percentile_s(double share) const;
};

}  // namespace vps::dynamics
