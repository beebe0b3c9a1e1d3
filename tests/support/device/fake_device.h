// SPDX-License-Identifier: BSD-3-Clause
// A device, a clock and a log for tests of the haptic loop, and waiting for a device that has a thread of its
// own.
#pragma once

#include <chrono>
#include <thread>
#include <vector>

#include "vps_device/device.h"
#include "vps_device/metronome.h"
#include "vps_device/run_log.h"

namespace vps::test {

/// A device whose sample the test sets; it keeps the wrench that was written last.
struct PlainDevice final : device::Device {
  device::DeviceSample read() noexcept override {
    if (on_read != nullptr) on_read(*this);
    return sample;
  }
  void write(const Wrench& F_Ho_D) noexcept override { F_written_D = F_Ho_D; }
  [[nodiscard]] device::DeviceLimits limits() const noexcept override { return {.peak_force_N = 30}; }
  [[nodiscard]] std::string_view name() const noexcept override { return "plain"; }

  device::DeviceSample sample;
  Wrench F_written_D;
  void (*on_read)(PlainDevice&) = nullptr;
};

/// A clock that the test controls: sleepUntil() sets it to the requested time plus `oversleep`.
struct FakeClock final : device::RealTimeClock {
  explicit FakeClock(std::int64_t start_ns = 0) : now(start_ns) {}
  [[nodiscard]] std::int64_t now_ns() noexcept override { return now; }
  void sleepUntil(std::int64_t time_ns) noexcept override {
    if (time_ns > now) now = time_ns;
    now += oversleep;
  }
  std::int64_t now, oversleep = 0;
};

/// A log that keeps its entries and counts the entries that were reported as lost.
class KeptLog final : public device::RunLog {
 public:
  void add(const device::LogEntry& entry) noexcept override { entries.push_back(entry); }
  void lose(std::uint64_t count) noexcept override { lost += count; }
  std::vector<device::LogEntry> entries;
  std::uint64_t lost = 0;
};

/// Reads until the claim holds; false after 10 s.
template <typename Claim>
bool within10s(device::Device& device, const Claim& claim) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (std::chrono::steady_clock::now() < end) {
    if (claim(device.read())) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

inline bool isThere(const device::DeviceSample& sample) {
  return sample.status == Status::Ok;
}

}  // namespace vps::test
