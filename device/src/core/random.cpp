// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/random.h"

#include <cmath>
#include <numbers>

namespace vps::device {

std::uint64_t Random::next() noexcept {
  state_ += 0x9e3779b97f4a7c15ull;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

double Random::uniform() noexcept {
  return static_cast<double>(next() >> 11) * 0x1p-53;
}

double Random::normal() noexcept {
  // 1 - u lies in (0, 1], where the logarithm is finite.
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));
  return radius * std::cos(2 * std::numbers::pi * uniform());
}

Vec3 Random::normal3() noexcept {
  // Named variables, since the evaluation order of arguments is unspecified.
  const double x = normal(), y = normal(), z = normal();
  return {x, y, z};
}

}  // namespace vps::device
