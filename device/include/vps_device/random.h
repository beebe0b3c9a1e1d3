// SPDX-License-Identifier: BSD-3-Clause
// Random numbers that are identical with every compiler and library, unlike std::normal_distribution.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "vps/pose.h"

namespace vps::device {

/// SplitMix64 [Steele, Lea and Flood 2014], and Box-Muller for normal numbers.
class Random {
 public:
  explicit Random(std::uint64_t seed = 1) : state_(seed) {}

  std::uint64_t next() noexcept {
    state_ += 0x9e3779b97f4a7c15ull;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  /// In [0, 1).
  double uniform() noexcept { return static_cast<double>(next() >> 11) * 0x1p-53; }
  /// Mean 0, standard deviation 1.
  double normal() noexcept {
    // 1 - u lies in (0, 1], where the logarithm is finite.
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }
  Vec3 normal3() noexcept {
    // Named variables, since the evaluation order of arguments is unspecified.
    const double x = normal(), y = normal(), z = normal();
    return {x, y, z};
  }

 private:
  std::uint64_t state_;
};

}  // namespace vps::device
