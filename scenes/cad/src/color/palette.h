// SPDX-License-Identifier: BSD-3-Clause
// Adds colours to a palette that holds each colour once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "vps_scenes/cad/colors.h"

namespace vps::scenes {

/// @invariant `colors` outlives the Palette; meanwhile only the Palette changes `colors`.
class Palette {
 public:
  explicit Palette(FaceColors& colors) : colors_(colors) {
    for (std::uint32_t i = 0; i < colors.palette.size(); ++i) known_.emplace(colors.palette[i], i);
  }
  /// Index of a colour in the palette, which is extended if necessary. O(log colours).
  std::uint32_t numberOf(const Color& color) {
    const auto [it, is_new] = known_.emplace(color, static_cast<std::uint32_t>(colors_.palette.size()));
    if (is_new) colors_.palette.push_back(color);
    return it->second;
  }
  /// Appends a triangle of this colour.
  void add(const Color& color) { colors_.of_triangle.push_back(numberOf(color)); }

 private:
  FaceColors& colors_;
  std::map<Color, std::uint32_t> known_;
};

}  // namespace vps::scenes
