// SPDX-License-Identifier: BSD-3-Clause
// Pseudo-random numbers that are the same on every platform.
#pragma once

#include <cstdint>
#include <random>

#include "vps/pose.h"

namespace vps::scenes {

/// Draws uniformly from [0, 1). std::uniform_real_distribution is not used, since its numbers depend on the
/// standard library.
class SeededDraw {
 public:
  explicit SeededDraw(std::uint64_t seed) : random_(seed) {}
  double operator()() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  /// Draws from the cube of size 1 around the origin, z first. Each coordinate has its own statement, because
  /// the evaluation order of arguments is unspecified; the order z, y, x keeps the results of earlier
  /// versions.
  Vec3 inUnitCube() {
    const double z = (*this)() - 0.5;
    const double y = (*this)() - 0.5;
    const double x = (*this)() - 0.5;
    return {x, y, z};
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace vps::scenes
