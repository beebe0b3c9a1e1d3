// SPDX-License-Identifier: BSD-3-Clause
// A device that is where the test says, and keeps what it was given.
#pragma once

#include "vps_device/device.h"

namespace vps_test {

struct PlainDevice final : vps::device::Device {
  vps::device::DeviceSample read() noexcept override {
    if (on_read != nullptr) on_read(*this);
    return sample;
  }
  void write(const vps::Wrench& F_Ho_D) noexcept override { F_written_D = F_Ho_D; }
  [[nodiscard]] vps::device::DeviceLimits limits() const noexcept override { return {.peak_force_N = 30}; }
  [[nodiscard]] std::string_view name() const noexcept override { return "plain"; }

  vps::device::DeviceSample sample;
  vps::Wrench F_written_D;
  void (*on_read)(PlainDevice&) = nullptr;
};

}  // namespace vps_test
