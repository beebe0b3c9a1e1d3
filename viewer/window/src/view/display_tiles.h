// SPDX-License-Identifier: BSD-3-Clause
// The pictures of a display file in one window: each screen as each viewer sees it, beside each other.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "view/camera_motion.h"
#include "vps_viewer/draw/stereo.h"

namespace vps::viewer {

/// What one projector or monitor shows: a screen for one viewer, or for one of the viewer's eyes.
struct DisplayOutput {
  std::string name;  ///< "front", "front_anna", "front_anna_left": as renderDisplay() names them
  std::size_t screen = 0, viewer = 0;
  int eye = 0;        ///< of Spectral: -1 left, 1 right; else 0
  double aspect = 1;  ///< width over height of the screen
};
[[nodiscard]] VPS_VIEWER_API std::vector<DisplayOutput> outputsOf(const scenes::Display& display,
                                                                  StereoMode mode);

/// A rectangle of a picture [px], y down.
struct TilePlace {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const TilePlace&) const = default;
  [[nodiscard]] bool has(double at_x, double at_y) const {
    return at_x >= x && at_y >= y && at_x < x + width && at_y < y + height;
  }
};
/// Rows of equal cells, as many as let the outputs be largest; each output is in the middle of its cell in
/// its own proportions. A single one fills the area.
[[nodiscard]] VPS_VIEWER_API std::vector<TilePlace> tilePlaces(std::span<const DisplayOutput> outputs,
                                                               PictureSize area);

}  // namespace vps::viewer
