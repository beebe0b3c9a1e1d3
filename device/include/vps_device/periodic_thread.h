// SPDX-License-Identifier: BSD-3-Clause
// A thread that calls a function at a fixed rate, with real-time priority where the system allows it.
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
  int priority = 0;                ///< SCHED_FIFO, 1 to 99; 0: normal scheduling
  bool locks_memory = false;       ///< locks the whole program in memory
  RealTimeClock* clock = nullptr;  ///< null: the system's monotonic clock
};

/// What the system granted of a request for real time.
struct RealTimeReport {
  bool has_priority = false;
  bool has_locked_memory = false;
  std::vector<std::string> warnings;  ///< messages for the user: each refusal, with its remedy
};

/// Calls a function at absolute times on a thread of its own, with SCHED_FIFO and locked memory if requested
/// and granted. The stack is touched beforehand, so that no page fault occurs later.
class VPS_DEVICE_API PeriodicThread {
 public:
  explicit PeriodicThread(const PeriodicSettings& settings);
  ~PeriodicThread();
  PeriodicThread(const PeriodicThread&) = delete;
  PeriodicThread& operator=(const PeriodicThread&) = delete;

  /// Calls `work` once per period until stop(). Returns when the thread runs. An exception from `work` ends
  /// the thread and is rethrown by stop(). Throws LoadError for a rate outside 1 Hz to 100 kHz.
  RealTimeReport start(std::function<void(const Beat&)> work);
  /// Waits for the end of the current beat. Rethrows an exception of the work, once. No effect if the thread
  /// does not run.
  void stop();
  /// False also once `work` has thrown.
  [[nodiscard]] bool isRunning() const noexcept { return is_running_.load(std::memory_order_acquire); }

 private:
  void run(const std::function<void(const Beat&)>& work);

  PeriodicSettings settings_;
  std::atomic<bool> is_ending_{false}, is_running_{false};
  std::exception_ptr failure_;
  std::thread thread_;
};

/// Requests priority for the calling thread and locked memory for the program; the report explains refusals.
/// Throws nothing but std::bad_alloc.
VPS_DEVICE_API RealTimeReport requestRealTime(int priority, bool locks_memory);
/// Returns the calling thread to normal scheduling.
VPS_DEVICE_API void leaveRealTime() noexcept;

}  // namespace vps::device
