// SPDX-License-Identifier: BSD-3-Clause
// Random numbers that are identical with every compiler and library, unlike std::normal_distribution.
#pragma once

#include <cstdint>

#include "vps/pose.h"
#include "vps_device/export.h"

namespace vps::device {

/// SplitMix64 [Steele, Lea and Flood 2014] and Box-Muller on top.
class VPS_DEVICE_API Random {
 public:
  explicit Random(std::uint64_t seed = 1) : state_(seed) {}
  std::uint64_t next() noexcept;
  double uniform() noexcept;  ///< [0, 1)
  double normal() noexcept;   ///< mean 0, deviation 1
  Vec3 normal3() noexcept;    ///< three of them

 private:
  std::uint64_t state_;
};

}  // namespace vps::device
