// SPDX-License-Identifier: BSD-3-Clause
// The machine: its memory and its clock.
#pragma once

#include <chrono>

#include <unistd.h>

namespace vps::scenes {

/// Total memory of this machine in bytes; 0 where the system does not report it.
inline double machineMemoryBytes() noexcept {
  const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
  return pages > 0 && page_bytes > 0 ? static_cast<double>(pages) * static_cast<double>(page_bytes) : 0;
}

/// Seconds of wall-clock time on a monotonic clock, from an arbitrary start, for reports.
inline double wallSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace vps::scenes
