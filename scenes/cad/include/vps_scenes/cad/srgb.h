// SPDX-License-Identifier: BSD-3-Clause
// The transfer function of sRGB (IEC 61966-2-1): between light and the numbers of a picture, both 0 to 1.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vps::scenes {

/// Both are O(1) and continuous.
inline double srgbFromLinear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}
inline double linearFromSrgb(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}
/// Rounded; light outside 0 to 1 is clamped.
inline std::uint8_t srgbByte(double linear) {
  return static_cast<std::uint8_t>(std::lround(255 * srgbFromLinear(std::clamp(linear, 0.0, 1.0))));
}

}  // namespace vps::scenes
