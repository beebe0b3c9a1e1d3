// SPDX-License-Identifier: BSD-3-Clause
// The contents of the last draft, so that the next draft draws changes only.
#pragma once

#include <optional>
#include <vector>

#include "render/view.h"
#include "vps_viewer/draw/image.h"

namespace vps::viewer {

/// The quantities that determine a draft, apart from the meshes.
struct DraftContents {
  Box box_W;  ///< see coarseBounds()
  Camera camera;
  DrawOptions options;  ///< without the options that only affect the overlay on the finished picture
  std::vector<DrawnBody> bodies;
  std::optional<DrawnBody> target;
  MarkList marks;
};

/// Greatest distance of a line's pixels from its part. Lines are up to 1.7 px wide in a picture of 960 px
/// height, and scale with the height.
[[nodiscard]] constexpr int lineMargin_px(int height) {
  return 4 + height / 320;
}

struct LastDraft {
  DraftContents contents;
  Image image;  ///< without title, legend and flash
};

/// A cube that replaces the box around everything that is drawn when the view of a draft is computed. The
/// cube stays the same while parts move a little. The view covers 2.2 half diagonals of the cube in each
/// direction.
/// @param last  cube of the last draft; kept if the box's half diagonal is 0.8 to 1.25 of the cube's and the
/// middles are less than 0.7 of the cube's half diagonal apart; null: no last draft
Box coarseBounds(const Box& box, const Box* last);

/// The rectangle outside of which both drafts have the same pixels; std::nullopt if their cameras or
/// options differ, so that everything must be drawn. O(bodies and marks).
/// @param view  view of `next`
std::optional<PixelRect> changedPixels(const DraftContents& last, const DraftContents& next, const View& view,
                                       int width, int height);

}  // namespace vps::viewer
