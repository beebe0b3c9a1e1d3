// SPDX-License-Identifier: BSD-3-Clause
// The pictures of a display file, tiled in one window: one for each screen and each viewer of it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "view/camera_motion.h"
#include "vps_viewer/draw/stereo.h"

namespace vps::viewer {

/// The picture of one projector or monitor: a screen seen by one viewer, or by one of the viewer's eyes.
struct DisplayOutput {
  std::string name;  ///< "front", "front_anna", "front_anna_left"; the names of renderDisplay()
  std::size_t screen = 0, viewer = 0;
  int eye = 0;        ///< Spectral stereo: -1 left, 1 right; other modes: 0
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

/// A view for two eyes, and the rectangle of the picture that shows it.
struct PictureTile {
  EyePair eyes;
  TilePlace place;  ///< place in a picture of the size in DrawOptions
  int eye = 0;      ///< the same values as DisplayOutput::eye
};

/// Lays the outputs out in rows of equal cells. The number of rows is chosen so that the outputs are as large
/// as possible. Each output keeps its aspect ratio and is centred in its cell; a single output fills the
/// area.
[[nodiscard]] VPS_VIEWER_API std::vector<TilePlace> tilePlaces(std::span<const DisplayOutput> outputs,
                                                               PictureSize area);

}  // namespace vps::viewer
