// SPDX-License-Identifier: BSD-3-Clause
// Colours of single faces of a part.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vps_scenes/export.h"

namespace vps::scenes {

/// Linear RGB, 0 to 1.
using Color = std::array<float, 3>;

/// As the numbers of a picture. Source: IEC 61966-2-1.
VPS_SCENES_API Color srgbFromLinear(const Color& linear);

/// The colour of each of a part's triangles, where they differ.
struct FaceColors {
  std::vector<Color> palette;
  std::vector<std::uint32_t> of_triangle;  ///< number in the palette; empty: the part has one colour

  [[nodiscard]] bool isNone() const { return of_triangle.empty(); }
  [[nodiscard]] const Color& at(std::size_t triangle) const { return palette[of_triangle[triangle]]; }
  bool operator==(const FaceColors&) const = default;
};

/// Appends the colours of `count` triangles: those of `from`, or `color` where it has none. A palette has
/// each colour once.
VPS_SCENES_API void append(FaceColors& to, std::size_t count, const FaceColors& from, const Color& color);

/// Of a mesh that has these of the triangles, in this order.
VPS_SCENES_API FaceColors ofTriangles(const FaceColors& colors, std::span<const std::uint32_t> triangles);

/// Where all triangles have one colour, it becomes the part's, and `colors` has none any more.
VPS_SCENES_API void simplify(FaceColors& colors, Color& color);

}  // namespace vps::scenes
