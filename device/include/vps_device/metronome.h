// SPDX-License-Identifier: BSD-3-Clause
// Waits for periods of a fixed rate by an absolute clock, without drift, and counts missed periods.
#pragma once

#include <cstdint>

#include "vps_device/export.h"

namespace vps::device {

/// Interface of a clock; tests use a clock of their own. Called by one thread at a time.
class VPS_DEVICE_API RealTimeClock {
 public:
  virtual ~RealTimeClock() = default;
  [[nodiscard]] virtual std::int64_t now_ns() noexcept = 0;
  /// Sleeps until the given time, and returns at or after it.
  virtual void sleepUntil(std::int64_t time_ns) noexcept = 0;
};

/// The system's monotonic clock, with absolute waits.
VPS_DEVICE_API RealTimeClock& monotonicClock() noexcept;
/// Time of the system's monotonic clock in seconds.
[[nodiscard]] inline double monotonicSeconds() noexcept {
  return 1e-9 * static_cast<double>(monotonicClock().now_ns());
}

/// One period that was waited for.
struct Beat {
  std::int64_t due_ns = 0;
  std::int64_t woke_ns = 0;          ///< the delay is woke_ns - due_ns
  std::int64_t periods = 1;          ///< periods since the last beat; 1 if none was missed
  std::int64_t missed_before = 0;    ///< periods missed because the work of the last beat took too long
  std::int64_t missed_asleep = 0;    ///< periods missed because the system woke the thread late
  bool has_clock_gone_back = false;  ///< the clock was set back, so the beats restart from now
};

/// Waits for one beat after the other. A beat that falls due while work is still running is missed, and
/// wait() returns at the next one. With `most_late_ns` above 0 a beat that falls due during work is late
/// instead of missed: wait() returns at once, so that occasional late work is made up for. Never throws,
/// allocates or locks.
class Metronome {
 public:
  /// @param period_ns  > 0
  /// @param most_late_ns  beats that are later than this are missed; >= 0
  Metronome(std::int64_t period_ns, RealTimeClock& clock, std::int64_t most_late_ns = 0) noexcept
      : period_ns_(period_ns), most_late_ns_(most_late_ns), clock_(&clock) {}

  /// The next wait() returns a period from now.
  void start() noexcept { due_ns_ = seen_ns_ = clock_->now_ns(); }
  Beat wait() noexcept;

  [[nodiscard]] std::int64_t period_ns() const noexcept { return period_ns_; }

 private:
  std::int64_t period_ns_, most_late_ns_;
  RealTimeClock* clock_;
  std::int64_t due_ns_ = 0, seen_ns_ = 0;
};

inline Beat Metronome::wait() noexcept {
  Beat beat;
  const std::int64_t now_ns = clock_->now_ns();
  if (now_ns < seen_ns_) {
    beat.has_clock_gone_back = true;
    due_ns_ = now_ns;
  }
  const std::int64_t over_ns = now_ns - (due_ns_ + period_ns_) - most_late_ns_;
  if (over_ns > 0) beat.missed_before = (over_ns + period_ns_ - 1) / period_ns_;
  due_ns_ += (1 + beat.missed_before) * period_ns_;

  if (due_ns_ > now_ns || most_late_ns_ == 0) clock_->sleepUntil(due_ns_);
  seen_ns_ = beat.woke_ns = clock_->now_ns();
  if (beat.woke_ns < now_ns) {  // the clock went back during the sleep
    beat.has_clock_gone_back = true;
    due_ns_ = beat.woke_ns;
  }
  if (beat.woke_ns - due_ns_ > most_late_ns_)
    beat.missed_asleep = (beat.woke_ns - due_ns_ - most_late_ns_) / period_ns_;
  due_ns_ += beat.missed_asleep * period_ns_;
  beat.due_ns = due_ns_;
  beat.periods = 1 + beat.missed_before + beat.missed_asleep;
  return beat;
}

}  // namespace vps::device
