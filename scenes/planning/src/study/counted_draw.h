// SPDX-License-Identifier: BSD-3-Clause
// Pseudo-random numbers that depend on a counter alone, not on the numbers drawn before.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace vps::scenes {

/// Draws for one run of a study and one name.
class CountedDraw {
 public:
  CountedDraw(std::uint64_t seed, std::uint64_t run, std::string_view name)
      : key_(mixed(mixed(mixed(seed) ^ run) ^ hashOf(name))) {}

  /// The k-th number of the key, all bits used.
  [[nodiscard]] std::uint64_t bits(std::uint64_t k) const { return mixed(key_ + k * kGolden); }
  /// From (0, 1), never an end.
  [[nodiscard]] double uniform(std::uint64_t k = 0) const {
    return (static_cast<double>(bits(k) >> 11) + 0.5) * 0x1p-53;
  }
  /// Standard normal. Source: [Box and Muller 1958].
  [[nodiscard]] double normal() const {
    return std::sqrt(-2 * std::log(uniform(0))) * std::cos(2 * std::numbers::pi * uniform(1));
  }

 private:
  static constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15;  // 2^64 / golden ratio, odd
  /// The finaliser of SplitMix64. Source: [Steele, Lea and Flood 2014].
  static std::uint64_t mixed(std::uint64_t x) {
    x += kGolden;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EB;
    return x ^ (x >> 31);
  }
  /// FNV-1a.
  static std::uint64_t hashOf(std::string_view text) {
    std::uint64_t hash = 0xCBF29CE484222325;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3;
    return hash;
  }

  std::uint64_t key_;
};

}  // namespace vps::scenes
