// SPDX-License-Identifier: BSD-3-Clause
// What the last draft shows, so that the next one draws only what changed.
#pragma once

#include <optional>
#include <vector>

#include "render/view.h"
#include "vps_viewer/draw/image.h"

namespace vps::viewer {

/// Everything that a draft depends on, besides the meshes.
struct DraftContents {
  Box box_W;  ///< see coarseBounds()
  Camera camera;
  DrawOptions options;  ///< without what is drawn on the finished picture
  std::vector<DrawnBody> bodies;
  std::optional<DrawnBody> target;
  MarkList marks;
};

/// Lines reach at most so far beyond a part: they are up to 1.7 px wide at a height of 960 px, in proportion.
[[nodiscard]] constexpr int lineMargin_px(int height) {
  return 4 + height / 320;
}

struct LastDraft {
  DraftContents contents;
  Image image;  ///< without title, legend and flash
};

/// A cube in place of the box around all that is drawn, from which the view of a draft follows: it stays the
/// same while parts move a little. The view takes in 2.2 half diagonals of it each way.
/// @param last  the last draft's, which is kept where its half diagonal is within a quarter of the box's and
///              the middle of the box within 0.7 of it; null: none
Box coarseBounds(const Box& box, const Box* last);

/// The rectangle outside of which both drafts have the same pixels; none: they see from different places, or
/// in different ways, and have nothing in common. O(bodies and marks).
/// @param view  of `next`
std::optional<PixelRect> changedPixels(const DraftContents& last, const DraftContents& next, const View& view,
                                       int width, int height);

}  // namespace vps::viewer
