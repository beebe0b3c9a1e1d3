// SPDX-License-Identifier: BSD-3-Clause
// Independent pieces of work on all cores.
#pragma once

#include <tbb/parallel_for.h>

#include <atomic>
#include <thread>

#include "vps/errors.h"

namespace vps::scenes {

/// Does `work(i)` for 0 to count - 1, and tells the progress on the caller's thread only. What either throws
/// ends it.
template <class Work>
void forEachOnCores(std::size_t count, const Progress& progress, const char* doing, Work work) {
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<std::size_t> done = 0;
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    work(i);
    ++done;
    if (progress && std::this_thread::get_id() == caller)
      progress(doing, static_cast<double>(done) / static_cast<double>(count));
  });
}

}  // namespace vps::scenes
