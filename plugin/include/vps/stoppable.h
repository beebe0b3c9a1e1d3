// SPDX-License-Identifier: BSD-3-Clause
// Long work that its caller can end: functions that take a Progress callback call it also from their inner
// loops, on every thread that works for them, so that an exception of the callback ends the work soon.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>

#include "vps/errors.h"
#include "vps/export.h"

namespace vps {

/// While an object of this class exists, pollStop() on its thread, and on the threads of onAllCores() that
/// work for it, repeats the latest report from time to time. If the callback throws, the exception leaves the
/// innermost loop that polls, on the thread that called the callback; every other thread gets the same
/// exception at its next poll. The results are not changed by polling: the work is complete, or it ends by
/// the exception.
///
///     Mesh slow(const Mesh& mesh, const Progress& progress) {
///       StoppableWork work(progress, "repairing");   // from here on, progress is called through `work`
///       for (...) { pollStop(); ... }                // also in any function that is called here
///     }
///
/// Objects on one thread are nested as scopes. An object with an empty callback leaves the enclosing object
/// in force.
class VPS_API StoppableWork {
 public:
  explicit StoppableWork(const Progress& progress, std::string_view doing = "", double share = 0);
  ~StoppableWork();
  StoppableWork(const StoppableWork&) = delete;
  StoppableWork& operator=(const StoppableWork&) = delete;

  /// Calls the callback, on one thread at a time, with a new report. A share that is less than the latest one
  /// of the same work comes late from another thread, and is raised to it. Thread-safe.
  void report(std::string_view doing, double share);

  /// pollStop() calls the callback at every 64th call on a thread, and after this time without a call.
  static constexpr unsigned kPollsPerCall = 64;
  static constexpr std::chrono::milliseconds kLongest{10};

 private:
  friend class WorkOnThread;
  friend VPS_API void pollStop();
  void poll();
  void call();  // with the lock

  const Progress& progress_;
  StoppableWork* const enclosing_;
  std::mutex lock_;
  std::string doing_;
  double share_;
  std::exception_ptr stop_;  // the callback's exception; set before is_stopped_
  std::atomic<bool> is_stopped_ = false;
  using Clock = std::chrono::steady_clock;
  std::atomic<Clock::time_point> called_ = Clock::now();
};

/// Ends the work of the current thread by the exception of the callback, if the callback throws. Call it once
/// for each piece of work of a microsecond or more, never in a function that is noexcept. Without a
/// StoppableWork, as on the threads of the haptic loop, it does nothing. Costs a look at the clock, about 25
/// ns.
VPS_API void pollStop();

/// For loops whose rounds are shorter: polls at every 256th call.
class StridedPoll {
 public:
  void operator()() {
    if (++rounds_ % 256 == 0) pollStop();
  }

 private:
  unsigned rounds_ = 0;
};

/// Makes the current thread work for another thread's StoppableWork until the end of the scope.
class VPS_API WorkOnThread {
 public:
  /// The work of the current thread; null if it has none.
  static StoppableWork* current();

  explicit WorkOnThread(StoppableWork* work);
  ~WorkOnThread();
  WorkOnThread(const WorkOnThread&) = delete;
  WorkOnThread& operator=(const WorkOnThread&) = delete;

 private:
  StoppableWork* const before_;
};

/// Calls `work(i)` for i = 0 to count - 1 on all cores; the calls poll for the caller's StoppableWork. An
/// exception of `work` ends the loop and is thrown on the caller's thread.
VPS_API void onAllCores(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace vps
