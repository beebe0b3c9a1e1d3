// SPDX-License-Identifier: BSD-3-Clause
// Times of an exchange between two ends at 1600 Hz.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "vps_device/metronome.h"

namespace vps::bench {

inline constexpr std::int64_t kPeriod_ns = 625'000;  // 1600 Hz

inline std::int64_t now_ns() {
  return device::monotonicClock().now_ns();
}

struct Times {
  explicit Times(std::vector<std::int64_t> ns) : all(std::move(ns)) { std::sort(all.begin(), all.end()); }
  [[nodiscard]] double us(double share) const {
    const auto rank = static_cast<std::size_t>(share * static_cast<double>(all.size() - 1));
    return 1e-3 * static_cast<double>(all[rank]);
  }
  std::vector<std::int64_t> all;
};

/// Calls `exchange` at 1600 Hz, with its number from 1 on, and times it.
template <typename Exchange>
Times timed(double seconds, const Exchange& exchange) {
  device::Metronome metronome(kPeriod_ns, device::monotonicClock());
  metronome.start();
  std::vector<std::int64_t> ns;
  const auto count = static_cast<std::int32_t>(1e9 * seconds / kPeriod_ns);
  ns.reserve(static_cast<std::size_t>(count));
  for (std::int32_t i = 1; i <= count; ++i) {
    metronome.wait();
    const std::int64_t begun_ns = now_ns();
    exchange(i);
    ns.push_back(now_ns() - begun_ns);
  }
  return Times(std::move(ns));
}

}  // namespace vps::bench
