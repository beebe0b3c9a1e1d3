// SPDX-License-Identifier: BSD-3-Clause
// Random numbers, vectors and rotations for tests. The arguments of a call may be evaluated in any order, so
// in Vec3(draw(), draw(), draw()) one compiler draws x first and another one z; within braces the order is
// that of the text.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "vps/pose.h"

namespace vps::test {

/// Random numbers that are the same with every standard library, by SplitMix64 [Steele, Lea and Flood 2014].
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15ull;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  double uniform(double low, double high) {
    return low + (high - low) * 0x1p-53 * static_cast<double>(bits() >> 11);
  }
  /// Every decade is equally likely. `low` and `high` must be positive.
  double logUniform(double low, double high) { return low * std::exp(uniform(0, std::log(high / low))); }
  /// 0 to count - 1.
  int index(int count) { return static_cast<int>(bits() % static_cast<std::uint64_t>(count)); }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  Vec3 direction() {
    const double z = uniform(-1, 1), angle_rad = uniform(0, 2 * std::numbers::pi), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle_rad), r * std::sin(angle_rad), z};
  }
  Mat3 rotation() { return rotationFromVector(direction() * uniform(0, std::numbers::pi)); }
  /// A small rotation about a random axis.
  Mat3 tilt(double most_rad) { return rotationFromVector(direction() * uniform(0, most_rad)); }
  Vec3 inBox(const Vec3& half) {
    return {uniform(-half.x(), half.x()), uniform(-half.y(), half.y()), uniform(-half.z(), half.z())};
  }

 private:
  std::uint64_t state_;
};

/// A vector from three draws of a distribution of the standard library, in the order x, y, z.
template <typename Distribution, typename Generator>
Vec3 drawnVector(Distribution& draw, Generator& random) {
  return {draw(random), draw(random), draw(random)};
}

/// Uniformly distributed over all directions.
template <typename Generator>
Vec3 drawnDirection(Generator& random) {
  std::normal_distribution<double> normal;
  return drawnVector(normal, random).normalized();
}

/// A rotation from four draws of a distribution of the standard library, w first; uniformly distributed over
/// all rotations if `draw` is a normal distribution.
template <typename Distribution, typename Generator>
Quat drawnRotation(Distribution& draw, Generator& random) {
  return Quat{draw(random), draw(random), draw(random), draw(random)}.normalized();
}

}  // namespace vps::test
