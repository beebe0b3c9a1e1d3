// SPDX-License-Identifier: BSD-3-Clause
// Wall-clock statistics of a loop that repeats.
#pragma once

#include <chrono>
#include <vector>

#include "vps_scenes/result.h"

namespace vps {

/// Collects durations in a buffer sized once, and sums them up at the end. Not part of any result that must
/// repeat.
class TickClock {
 public:
  explicit TickClock(double period_s = 0) : period_us_(period_s * 1e6) {}
  void reserve(std::size_t ticks) { us_.reserve(ticks); }
  void start() { begun_ = Clock::now(); }
  void stop() { add(std::chrono::duration<double, std::micro>(Clock::now() - begun_).count()); }
  void add(double us) { us_.push_back(us); }
  /// O(n log n).
  [[nodiscard]] TickTimes summary() const;

 private:
  using Clock = std::chrono::steady_clock;
  double period_us_;
  Clock::time_point begun_;
  std::vector<double> us_;
};

}  // namespace vps
