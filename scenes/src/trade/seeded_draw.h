// SPDX-License-Identifier: BSD-3-Clause
// Pseudo-random numbers that are the same on every platform.
#pragma once

#include <cstdint>
#include <random>

namespace vps::scenes::inline v0 {

/// Draws from [0, 1). Not std::uniform_real_distribution, whose numbers depend on the standard library.
class SeededDraw {
 public:
  explicit SeededDraw(std::uint64_t seed) : random_(seed) {}
  double operator()() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 random_;
};

}  // namespace vps::scenes::inline v0
