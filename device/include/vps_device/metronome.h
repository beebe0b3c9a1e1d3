// SPDX-License-Identifier: BSD-3-Clause
// Beats at a fixed rate by an absolute clock: no drift, no bursts, and it says what was missed.
#pragma once

#include <cstdint>

#include "vps_device/export.h"

namespace vps::device {

/// A clock to wait by; another one in tests. Called by one thread at a time.
class VPS_DEVICE_API RealTimeClock {
 public:
  virtual ~RealTimeClock() = default;
  [[nodiscard]] virtual std::int64_t now_ns() noexcept = 0;
  /// Returns at or after that time.
  virtual void sleepUntil(std::int64_t time_ns) noexcept = 0;
};

/// The system's monotonic clock, by absolute waits.
VPS_DEVICE_API RealTimeClock& monotonicClock() noexcept;

/// One beat.
struct Beat {
  std::int64_t due_ns = 0;
  std::int64_t woke_ns = 0;
  std::int64_t periods = 1;          ///< since the beat before: 1 when none was missed
  std::int64_t missed_before = 0;    ///< of these, passed while the work of the beat before went on
  std::int64_t missed_asleep = 0;    ///< and while the system did not wake us
  bool has_clock_gone_back = false;  ///< the beats begin anew from now
};

/// Waits for one beat after the other. Work that runs beyond a beat costs that beat: the next is the first
/// that is still to come, never several at once. Never throws, allocates, locks.
class VPS_DEVICE_API Metronome {
 public:
  /// @param period_ns  > 0
  Metronome(std::int64_t period_ns, RealTimeClock& clock) noexcept : period_ns_(period_ns), clock_(&clock) {}

  /// The next wait() is for a period from now.
  void start() noexcept;
  Beat wait() noexcept;

  [[nodiscard]] std::int64_t period_ns() const noexcept { return period_ns_; }

 private:
  std::int64_t period_ns_;
  RealTimeClock* clock_;
  std::int64_t due_ns_ = 0, seen_ns_ = 0;
};

}  // namespace vps::device
