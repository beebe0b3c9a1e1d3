// SPDX-License-Identifier: BSD-3-Clause
// Wall-clock time for reports.
#pragma once

#include <chrono>

namespace vps::scenes {

/// Seconds on a monotonic clock, from an arbitrary start.
inline double wallSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace vps::scenes
