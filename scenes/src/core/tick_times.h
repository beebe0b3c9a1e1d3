// SPDX-License-Identifier: BSD-3-Clause
// Wall-clock statistics of a loop that repeats.
#pragma once

#include <chrono>
#include <vector>

#include "vps_scenes/result.h"

namespace vps::scenes::inline v0 {

/// Collects durations and summarises them at the end. Not part of any result that must repeat.
class TickClock {
 public:
  explicit TickClock(double period_s = 0) : period_us_(period_s * 1e6) {}
  void start() {
    cpu_begun_us_ = threadTime_us();
    begun_ = Clock::now();
  }
  void stop() {
    add(std::chrono::duration<double, std::micro>(Clock::now() - begun_).count());
    cpu_us_.push_back(threadTime_us() - cpu_begun_us_);
  }
  void add(double us) { us_.push_back(us); }
  /// O(n log n).
  [[nodiscard]] TickTimes summary() const;

 private:
  using Clock = std::chrono::steady_clock;
  static double threadTime_us();
  double period_us_;
  double cpu_begun_us_ = 0;
  Clock::time_point begun_;
  std::vector<double> us_, cpu_us_;
};

}  // namespace vps::scenes::inline v0
