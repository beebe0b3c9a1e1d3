// SPDX-License-Identifier: BSD-3-Clause
// Colours: linear and sRGB values, and the colours of single faces of a part.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vps_scenes/export.h"

namespace vps::scenes {

/// The transfer function of sRGB (IEC 61966-2-1): from light to the number in a picture, both 0 to 1. O(1).
inline double srgbFromLinear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}
/// The inverse of srgbFromLinear().
inline double linearFromSrgb(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}
/// srgbFromLinear() as a byte, rounded; light outside 0 to 1 is clamped.
inline std::uint8_t srgbByte(double linear) {
  return static_cast<std::uint8_t>(std::lround(255 * srgbFromLinear(std::clamp(linear, 0.0, 1.0))));
}

/// Linear RGB, 0 to 1.
using Color = std::array<float, 3>;

/// The sRGB values of a linear colour.
VPS_SCENES_API Color srgbFromLinear(const Color& linear);

/// The colours of a part's triangles, where these differ.
struct FaceColors {
  std::vector<Color> palette;
  std::vector<std::uint32_t>
      of_triangle;  ///< index into the palette for each triangle; empty: the part has one colour

  [[nodiscard]] bool isNone() const { return of_triangle.empty(); }
  [[nodiscard]] const Color& at(std::size_t triangle) const { return palette[of_triangle[triangle]]; }
  bool operator==(const FaceColors&) const = default;
};

/// Appends the colours of `count` triangles: the colours in `from`, or `color` for all if `from` has none. A
/// palette holds each colour once.
VPS_SCENES_API void append(FaceColors& to, std::size_t count, const FaceColors& from, const Color& color);

/// The colours of a mesh that consists of the given triangles, in this order.
VPS_SCENES_API FaceColors ofTriangles(const FaceColors& colors, std::span<const std::uint32_t> triangles);

/// If all triangles have one colour, sets `color` to it and empties `colors`.
VPS_SCENES_API void simplify(FaceColors& colors, Color& color);

}  // namespace vps::scenes
