// SPDX-License-Identifier: BSD-3-Clause
// A clock that the test controls: sleepUntil() sets it to the requested time plus `oversleep`.
#pragma once

#include "vps_device/metronome.h"

namespace vps_test {

struct FakeClock final : vps::device::RealTimeClock {
  explicit FakeClock(std::int64_t start_ns = 0) : now(start_ns) {}
  [[nodiscard]] std::int64_t now_ns() noexcept override { return now; }
  void sleepUntil(std::int64_t time_ns) noexcept override {
    if (time_ns > now) now = time_ns;
    now += oversleep;
  }
  std::int64_t now, oversleep = 0;
};

}  // namespace vps_test
