// SPDX-License-Identifier: BSD-3-Clause
// How long things take, for reports.
#pragma once

#include <chrono>

namespace vps::scenes {

/// Of a clock that never goes back, from a start of its own.
inline double wallSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace vps::scenes
