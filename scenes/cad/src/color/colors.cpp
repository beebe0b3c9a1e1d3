// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/cad/colors.h"

#include <cmath>

#include "color/palette.h"

namespace vps::scenes {

Color srgbFromLinear(const Color& linear) {
  Color srgb{};
  for (std::size_t i = 0; i < 3; ++i) {
    const float c = linear[i];
    srgb[i] = static_cast<float>(vps::scenes::srgbFromLinear(static_cast<double>(c)));
  }
  return srgb;
}

void append(FaceColors& to, std::size_t count, const FaceColors& from, const Color& color) {
  Palette palette(to);
  if (from.isNone()) {
    if (count > 0) to.of_triangle.insert(to.of_triangle.end(), count, palette.numberOf(color));
    return;
  }
  std::vector<std::uint32_t> number;
  for (const Color& each : from.palette) number.push_back(palette.numberOf(each));
  for (std::size_t i = 0; i < count; ++i) to.of_triangle.push_back(number[from.of_triangle[i]]);
}

FaceColors ofTriangles(const FaceColors& colors, std::span<const std::uint32_t> triangles) {
  if (colors.isNone()) return {};
  FaceColors out{colors.palette, {}};
  out.of_triangle.reserve(triangles.size());
  for (const std::uint32_t triangle : triangles) out.of_triangle.push_back(colors.of_triangle[triangle]);
  return out;
}

void simplify(FaceColors& colors, Color& color) {
  if (colors.isNone()) return;
  const Color& first = colors.at(0);
  for (std::size_t i = 1; i < colors.of_triangle.size(); ++i)
    if (colors.at(i) != first) return;
  color = first;
  colors = {};
}

}  // namespace vps::scenes
