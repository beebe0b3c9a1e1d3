// SPDX-License-Identifier: BSD-3-Clause
#include "step_times.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>

namespace vps::dynamics {

double threadTime_s() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double StepTimes::mean_s() const {
  if (step_s.empty()) return 0;
  return std::accumulate(step_s.begin(), step_s.end(), 0.0) / static_cast<double>(step_s.size());
}

double StepTimes::percentile_s(double share) const {
  if (step_s.empty()) return 0;
  std::vector<double> sorted = step_s;
  std::sort(sorted.begin(), sorted.end());
  const double at = std::ceil(share * static_cast<double>(sorted.size())) - 1;
  return sorted[static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(sorted.size() - 1)))];
}

}  // namespace vps::dynamics
