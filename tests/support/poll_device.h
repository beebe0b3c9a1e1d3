// SPDX-License-Identifier: BSD-3-Clause
// Waiting for what a device that has a thread of its own will read.
#pragma once

#include <chrono>
#include <thread>

#include "vps_device/device.h"

namespace vps::test {

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
