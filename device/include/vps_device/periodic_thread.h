// SPDX-License-Identifier: BSD-3-Clause
// A thread that does one thing at a fixed rate, before other programs where the system lets it.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "vps_device/export.h"
#include "vps_device/metronome.h"

namespace vps::device {

struct PeriodicSettings {
  double rate_hz = 1000;
  int priority = 0;                ///< SCHED_FIFO, 1 to 99; 0: as any other thread
  bool locks_memory = false;       ///< keeps the whole program in memory
  RealTimeClock* clock = nullptr;  ///< null: the system's monotonic clock
};

/// What the system allowed.
struct RealTimeReport {
  bool has_priority = false;
  bool has_locked_memory = false;
  std::vector<std::string> warnings;  ///< for a person: what was refused, and what would help
};

/// Beats in a thread of its own: absolute times, SCHED_FIFO and locked memory where wished and allowed, its
/// stack touched beforehand, so that no page fault comes in the middle.
class VPS_DEVICE_API PeriodicThread {
 public:
  explicit PeriodicThread(const PeriodicSettings& settings);
  ~PeriodicThread();
  PeriodicThread(const PeriodicThread&) = delete;
  PeriodicThread& operator=(const PeriodicThread&) = delete;

  /// Calls `work` once a period until stop(). Returns when the thread runs. Work that throws ends the thread;
  /// the exception comes out of stop(). Throws LoadError for a rate that is not within 1 Hz to 100 kHz.
  RealTimeReport start(std::function<void(const Beat&)> work);
  /// Waits for the end of the beat that is under way. Throws what the work threw, once. No effect if not
  /// running.
  void stop();
  /// False once work has thrown, too.
  [[nodiscard]] bool isRunning() const noexcept { return is_running_.load(std::memory_order_acquire); }

 private:
  void run(const std::function<void(const Beat&)>& work);

  PeriodicSettings settings_;
  std::atomic<bool> is_ending_{false}, is_running_{false};
  std::exception_ptr failure_;
  std::thread thread_;
};

/// Asks the system for the calling thread's priority and the program's memory; words for what it refuses.
/// Never throws but for want of memory.
VPS_DEVICE_API RealTimeReport askForRealTime(int priority, bool locks_memory);
/// The calling thread goes on as any other.
VPS_DEVICE_API void leaveRealTime() noexcept;

}  // namespace vps::device
