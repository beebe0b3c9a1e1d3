// SPDX-License-Identifier: BSD-3-Clause
#include "render/screen_box.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "mesh/box_corners.h"

namespace vps::viewer {
namespace {

/// Around the points; all of the picture where one of them is behind the near plane.
PixelRect around(std::span<const Vec3> points_C, const View& view, int width, int height, int margin_px) {
  const PixelRect whole = {0, 0, width, height};
  Eigen::Array2d low(1, 1), high(-1, -1);
  for (const Vec3& p_C : points_C) {
    if (!(p_C.z() <= -view.near_m)) return whole;
    const Eigen::Array2d ndc = (p_C.head<2>().array() / -p_C.z() - view.shift.cast<double>().array()) /
                               view.half_view.cast<double>().array();
    low = low.min(ndc);
    high = high.max(ndc);
  }
  low = low.max(-1.0);
  high = high.min(1.0);
  const auto first = [&](double ndc, int length) {
    return static_cast<GLint>(std::floor(0.5 * (ndc + 1) * length)) - margin_px;
  };
  const auto last = [&](double ndc, int length) {
    return static_cast<GLint>(std::ceil(0.5 * (ndc + 1) * length)) + margin_px;
  };
  const GLint x = first(low.x(), width), y = first(low.y(), height);
  return intersection({x, y, last(high.x(), width) - x, last(high.y(), height) - y}, whole);
}

}  // namespace

PixelRect intersection(const PixelRect& a, const PixelRect& b) {
  const GLint x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  return {x, y, std::max(0, std::min(a.x + a.width, b.x + b.width) - x),
          std::max(0, std::min(a.y + a.height, b.y + b.height) - y)};
}

PixelRect join(const PixelRect& a, const PixelRect& b) {
  if (a.isEmpty()) return b;
  if (b.isEmpty()) return a;
  const GLint x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

std::array<PixelRect, 4> around(const PixelRect& all, const PixelRect& inner) {
  const GLint right = inner.x + inner.width, top = inner.y + inner.height;
  return {{{all.x, all.y, all.width, inner.y - all.y},
           {all.x, top, all.width, all.y + all.height - top},
           {all.x, inner.y, inner.x - all.x, inner.height},
           {right, inner.y, all.x + all.width - right, inner.height}}};
}

PixelRect scaled(const PixelRect& rect, int factor) {
  return {rect.x * factor, rect.y * factor, rect.width * factor, rect.height * factor};
}

PixelRect boxOnScreen(const DrawnBody& body, const View& view, int width, int height, int margin_px) {
  std::array<Vec3, 8> points_C = corners(body.mesh->bounds_P);
  for (Vec3& p : points_C) p = body.X_CP * (p - body.mesh->shading.center);
  return around(points_C, view, width, height, margin_px);
}

PixelRect markOnScreen(const Mark& mark, const View& view, int width, int height) {
  const double reach_m = std::hypot(mark.size_m[0], mark.size_m[1]);
  const Vec3 base_C(mark.base_C[0], mark.base_C[1], mark.base_C[2]);
  const std::array<Vec3, 8> points_C =
      corners(Box{base_C - Vec3::Constant(reach_m), base_C + Vec3::Constant(reach_m)});
  return around(points_C, view, width, height, 2);
}

}  // namespace vps::viewer
