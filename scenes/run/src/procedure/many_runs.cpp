// SPDX-License-Identifier: BSD-3-Clause
#include "procedure/many_runs.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>

namespace vps::scenes {

namespace {

constexpr std::chrono::milliseconds kReportPeriod{50};  // assumed: no delay that a person notices

/// State that the workers share.
struct Shared {
  std::atomic<std::size_t> next = 0;  ///< the run that begins next
  std::atomic<unsigned> at_work = 0;  ///< workers that have not ended
  std::atomic<bool> stop = false;
  std::mutex mutex;          ///< protects `error`
  std::exception_ptr error;  ///< the first exception that was thrown

  void fail() noexcept {
    const std::lock_guard lock(mutex);
    if (!error) error = std::current_exception();
    stop = true;
  }
};

}  // namespace

void forEachRun(std::size_t count, const ManyRunsOptions& options,
                const std::function<void(std::size_t i, const std::atomic<bool>& stop)>& run) {
  if (count == 0) return;
  const unsigned cores =
      options.threads != 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  const auto threads = static_cast<unsigned>(std::min<std::size_t>(cores, count));
  Shared shared;
  shared.at_work = threads;
  const auto work = [&]() noexcept {
    // Parallel loops of a run stay in an arena of their own, so that a worker that waits for a parallel loop
    // does not begin another run during the wait.
    tbb::task_arena own(options.has_one_core_each ? 1 : tbb::task_arena::automatic);
    for (std::size_t i = shared.next++; i < count && !shared.stop; i = shared.next++) try {
        own.execute([&] { run(i, shared.stop); });
      } catch (const RunStopped&) {  // `stop` is set, so no further run begins
      } catch (...) {
        shared.fail();
      }
    --shared.at_work;  // a worker's last use of this stack frame
  };
  // The calling thread reports and does not work, and TBB has one worker less than there are cores.
  const std::size_t allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const tbb::global_control more(tbb::global_control::max_allowed_parallelism,
                                 std::max<std::size_t>(allowed, threads + 1));
  tbb::task_arena workers(static_cast<int>(threads), 0);
  unsigned begun = 0;
  try {
    for (; begun < threads; ++begun) workers.enqueue(work);
  } catch (
      ...) {  // no memory for a task: those that were enqueued use this stack frame until they have ended
    shared.at_work -= threads - begun;
    shared.fail();
  }
  bool may_report = options.report != nullptr;
  while (shared.at_work > 0) {
    std::this_thread::sleep_for(kReportPeriod);
    if (options.stop != nullptr && *options.stop) shared.stop = true;
    if (may_report) try {
        options.report(std::min(count, shared.next.load()));
      } catch (...) {
        may_report = false;
        shared.fail();
      }
  }
  if (shared.error) std::rethrow_exception(shared.error);
}

}  // namespace vps::scenes
