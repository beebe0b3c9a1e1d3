// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/tick_times.h"

#include <time.h>

namespace vps::scenes {

double TickClock::threadTime_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

TickTimes timesOf(const device::TickHistogram::Summary& all, std::uint64_t missed) {
  const auto us = [](std::int64_t ns) { return 1e-3 * static_cast<double>(ns); };
  TickTimes times;
  times.count = all.count;
  times.missed = missed;
  times.p50_us = us(all.p50_ns);
  times.p99_us = us(all.p99_ns);
  times.p999_us = us(all.p999_ns);
  times.max_us = us(all.max_ns);
  return times;
}

TickTimes TickClock::summary() const {
  const device::TickHistogram::Summary all = all_.summary(), cpu = cpu_.summary();
  if (all.count == 0) return {};
  TickTimes times = timesOf(all, missed_);
  times.mean_us = sum_us_ / static_cast<double>(all.count);
  times.cpu_p50_us = 1e-3 * static_cast<double>(cpu.p50_ns);
  times.cpu_p99_us = 1e-3 * static_cast<double>(cpu.p99_ns);
  return times;
}

}  // namespace vps::scenes
