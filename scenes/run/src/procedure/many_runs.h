// SPDX-License-Identifier: BSD-3-Clause
// Independent runs in parallel: the tries of a procedure and the samples of a tolerance study.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace vps::scenes {

/// Leaves a run whose stop is set; forEachRun() takes it as the end of that run.
struct RunStopped {};

struct ManyRunsOptions {
  unsigned threads = 0;                     ///< number of threads for the runs; 0: one for each core
  bool has_one_core_each = false;           ///< a run uses no more than one core for its parallel loops
  const std::atomic<bool>* stop = nullptr;  ///< set by the user; null: the runs cannot be stopped
  /// Called on the caller's thread every 50 ms with the number of runs that were begun; `report` may throw.
  /// An empty function is not called.
  std::function<void(std::size_t begun)> report{};
};

/// Calls run(i, stop) for i from 0 to count - 1 in this order, each on one of the threads, and returns when
/// all calls have returned. After `stop` is set, no further run begins. `stop` is set when options.stop is
/// set, or when a run or options.report throws; forEachRun() then throws the first exception again. Results
/// are the same for any number of threads if run(i) depends on i alone. The runs are one after the other if
/// the caller has limited TBB's threads to one. Must not be called from a task of TBB: the calling thread
/// waits.
void forEachRun(std::size_t count, const ManyRunsOptions& options,
                const std::function<void(std::size_t i, const std::atomic<bool>& stop)>& run);

}  // namespace vps::scenes
