// SPDX-License-Identifier: BSD-3-Clause
#include "core/tick_times.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vps::scenes::inline v0 {

namespace {

/// Nearest-rank percentile of sorted values.
double percentile(const std::vector<double>& sorted, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}

}  // namespace

double TickClock::threadTime_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

TickTimes TickClock::summary() const {
  TickTimes times;
  times.count = us_.size();
  if (us_.empty()) return times;
  std::vector<double> sorted = us_;
  std::sort(sorted.begin(), sorted.end());
  times.p50_us = percentile(sorted, 0.5);
  times.p99_us = percentile(sorted, 0.99);
  times.p999_us = percentile(sorted, 0.999);
  times.max_us = sorted.back();
  times.mean_us = std::accumulate(sorted.begin(), sorted.end(), 0.0) / static_cast<double>(sorted.size());
  if (period_us_ > 0)
    times.missed =
        static_cast<std::uint64_t>(sorted.end() - std::upper_bound(sorted.begin(), sorted.end(), period_us_));
  if (cpu_us_.empty()) return times;
  sorted = cpu_us_;
  std::sort(sorted.begin(), sorted.end());
  times.cpu_p50_us = percentile(sorted, 0.5);
  times.cpu_p99_us = percentile(sorted, 0.99);
  return times;
}

}  // namespace vps::scenes::inline v0
