// SPDX-License-Identifier: BSD-3-Clause
// Numbers that look like chance and are the same everywhere.
#pragma once

#include <cstdint>
#include <random>

namespace vps::scenes {

/// Draws from 0 (included) to 1. Not std::uniform_real_distribution: its numbers are the library's own
/// affair.
class SeededDraw {
 public:
  explicit SeededDraw(std::uint64_t seed) : random_(seed) {}
  double operator()() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 random_;
};

}  // namespace vps::scenes
