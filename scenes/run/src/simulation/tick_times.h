// SPDX-License-Identifier: BSD-3-Clause
// Wall-clock statistics of a loop that repeats.
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>

#include "vps_device/tick_statistics.h"
#include "vps_scenes/run/result.h"

namespace vps::scenes {

/// The percentiles of a histogram, without mean and processor time.
TickTimes timesOf(const device::TickHistogram::Summary& all, std::uint64_t missed);

/// Collects durations in histograms of constant size. Durations are not part of any result that must repeat.
class TickClock {
 public:
  explicit TickClock(double period_s = 0) : period_us_(period_s * 1e6) {}
  void start() {
    cpu_begun_us_ = threadTime_us();
    begun_ = Clock::now();
  }
  void stop() {
    add(std::chrono::duration<double, std::micro>(Clock::now() - begun_).count());
    cpu_.add(toNs(threadTime_us() - cpu_begun_us_));
  }
  void add(double us) {
    all_.add(toNs(us));
    sum_us_ += us;
    missed_ += period_us_ > 0 && us > period_us_ ? 1 : 0;
  }
  /// Percentiles are at most 1/64 too large (TickHistogram).
  [[nodiscard]] TickTimes summary() const;

 private:
  using Clock = std::chrono::steady_clock;
  static double threadTime_us();
  static std::int64_t toNs(double us) { return std::llround(1e3 * us); }
  double period_us_;
  double cpu_begun_us_ = 0;
  Clock::time_point begun_;
  device::TickHistogram all_, cpu_;
  double sum_us_ = 0;
  std::uint64_t missed_ = 0;
};

}  // namespace vps::scenes
