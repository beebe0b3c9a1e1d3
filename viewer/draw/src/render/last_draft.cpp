// SPDX-License-Identifier: BSD-3-Clause
#include "render/last_draft.h"

#include <algorithm>
#include <cmath>

namespace vps::viewer {
namespace {

bool isSameBody(const DrawnBody& a, const DrawnBody& b) {
  return a.mesh == b.mesh && a.part == b.part && a.X_CP.R == b.X_CP.R && a.X_CP.p == b.X_CP.p &&
         a.color == b.color && a.shows_faces == b.shows_faces && a.is_cut == b.is_cut && a.detail == b.detail;
}

bool isSameMark(const Mark& a, const Mark& b) {
  return a.base_C == b.base_C && a.axis_C == b.axis_C && a.size_m == b.size_m && a.color == b.color;
}

/// Collects the rectangles of bodies and marks that only one of two drafts has.
class Changes {
 public:
  Changes(const View& view, int width, int height)
      : view_(view), width_(width), height_(height), margin_px_(lineMargin_px(height)) {}

  void add(const DrawnBody& body) {
    rect_ = join(rect_, boxOnScreen(body, view_, width_, height_, margin_px_));
  }
  void add(const std::vector<Mark>& last, const std::vector<Mark>& next) {
    if (std::ranges::equal(last, next, isSameMark)) return;
    for (const std::vector<Mark>* marks : {&last, &next})
      for (const Mark& mark : *marks) rect_ = join(rect_, markOnScreen(mark, view_, width_, height_));
  }
  [[nodiscard]] const PixelRect& rect() const { return rect_; }

 private:
  const View& view_;
  int width_, height_;
  int margin_px_;
  PixelRect rect_;
};

}  // namespace

Box coarseBounds(const Box& box, const Box* last) {
  const double radius_m = box.isEmpty() ? 0 : 0.5 * box.size().norm();
  if (!(radius_m > 0) || !std::isfinite(radius_m)) return box;
  if (last != nullptr && !last->isEmpty()) {
    const double last_m = 0.5 * last->size().norm();
    if (radius_m > 0.8 * last_m && radius_m < 1.25 * last_m &&
        (box.center() - last->center()).norm() < 0.7 * last_m)
      return *last;
  }
  const double coarse_m = std::exp2(0.25 * std::round(4 * std::log2(radius_m)));
  const double step_m = 0.5 * coarse_m;
  const Vec3 center = (box.center() / step_m).array().round() * step_m;
  const Vec3 half = Vec3::Constant(coarse_m / std::sqrt(3.0));
  return {center - half, center + half};
}

std::optional<PixelRect> changedPixels(const DraftContents& last, const DraftContents& next, const View& view,
                                       int width, int height) {
  if (!(last.camera == next.camera) || !(last.options == next.options) || last.box_W.min != next.box_W.min ||
      last.box_W.max != next.box_W.max)
    return std::nullopt;
  Changes changes(view, width, height);
  // Parts come in the snapshot's order, which seldom changes.
  const std::size_t most = std::max(last.bodies.size(), next.bodies.size());
  for (std::size_t i = 0; i < most; ++i) {
    const bool is_last = i < last.bodies.size(), is_next = i < next.bodies.size();
    if (is_last && is_next && isSameBody(last.bodies[i], next.bodies[i])) continue;
    if (is_last) changes.add(last.bodies[i]);
    if (is_next) changes.add(next.bodies[i]);
  }
  if (last.target.has_value() != next.target.has_value() ||
      (last.target && !isSameBody(*last.target, *next.target))) {
    if (last.target) changes.add(*last.target);
    if (next.target) changes.add(*next.target);
  }
  changes.add(last.marks.arrows, next.marks.arrows);
  changes.add(last.marks.discs, next.marks.discs);
  return changes.rect();
}

}  // namespace vps::viewer
