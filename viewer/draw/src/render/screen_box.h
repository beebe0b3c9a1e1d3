// SPDX-License-Identifier: BSD-3-Clause
// Where in a picture something is, in whole pixels.
#pragma once

#include <array>

#include "gl/scene_buffers.h"
#include "marks/marks.h"
#include "render/view.h"

namespace vps::viewer {

/// Pixels from the lower left corner, as OpenGL counts.
struct PixelRect {
  GLint x = 0, y = 0;
  GLsizei width = 0, height = 0;

  [[nodiscard]] bool isEmpty() const { return width <= 0 || height <= 0; }
  bool operator==(const PixelRect&) const = default;
};
PixelRect intersection(const PixelRect& a, const PixelRect& b);
/// The least rectangle around both; an empty one has no place.
PixelRect join(const PixelRect& a, const PixelRect& b);
/// What the first has around the second, which lies in it: below, above, left, right.
std::array<PixelRect, 4> around(const PixelRect& all, const PixelRect& inner);
/// Pixels of a picture that is `factor` times as large.
PixelRect scaled(const PixelRect& rect, int factor);

/// Around a part, in a picture of that size. All of it where the part reaches behind the near plane.
/// @param margin_px  beyond the part on each side, as lines along its outline need
PixelRect boxOnScreen(const DrawnBody& body, const View& view, int width, int height, int margin_px);
/// Around an arrow or a disc, likewise.
PixelRect markOnScreen(const Mark& mark, const View& view, int width, int height);

}  // namespace vps::viewer
