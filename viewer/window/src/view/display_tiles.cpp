// SPDX-License-Identifier: BSD-3-Clause
#include "view/display_tiles.h"

#include <algorithm>
#include <cmath>

namespace vps::viewer {
namespace {

constexpr double kGap_px = 4;  // between outputs, so that their borders are visible

/// The largest rectangle of the given aspect ratio, centred in a cell.
TilePlace fitted(double aspect, double x, double y, double width, double height) {
  const double w = std::min(width, height * aspect), h = w / aspect;
  return {static_cast<int>(std::lround(x + 0.5 * (width - w))),
          static_cast<int>(std::lround(y + 0.5 * (height - h))), std::max(1, static_cast<int>(w)),
          std::max(1, static_cast<int>(h))};
}

std::vector<TilePlace> inRows(std::span<const DisplayOutput> outputs, PictureSize area, int rows) {
  const int count = static_cast<int>(outputs.size()), columns = (count + rows - 1) / rows;
  const double cell_w = (area.width - (columns - 1) * kGap_px) / columns;
  const double cell_h = (area.height - (rows - 1) * kGap_px) / rows;
  std::vector<TilePlace> places;
  for (int i = 0; i < count; ++i)
    places.push_back(fitted(outputs[static_cast<std::size_t>(i)].aspect, (i % columns) * (cell_w + kGap_px),
                            (i / columns) * (cell_h + kGap_px), std::max(1.0, cell_w),
                            std::max(1.0, cell_h)));
  return places;
}

}  // namespace

std::vector<DisplayOutput> outputsOf(const scenes::Display& display, StereoMode mode) {
  std::vector<DisplayOutput> outputs;
  for (std::size_t s = 0; s < display.screens.size(); ++s)
    for (std::size_t v = 0; v < display.viewers.size(); ++v) {
      const scenes::DisplayScreen& screen = display.screens[s];
      DisplayOutput output{screen.name, s, v, 0,
                           (screen.lower_right_S - screen.lower_left_S).norm() /
                               (screen.upper_left_S - screen.lower_left_S).norm()};
      if (display.viewers.size() > 1) output.name += "_" + display.viewers[v].name;
      if (mode != StereoMode::Spectral) {
        outputs.push_back(output);
        continue;
      }
      for (const int eye : {-1, 1}) {
        outputs.push_back(output);
        outputs.back().eye = eye;
        outputs.back().name += eye < 0 ? "_left" : "_right";
      }
    }
  return outputs;
}

std::vector<TilePlace> tilePlaces(std::span<const DisplayOutput> outputs, PictureSize area) {
  if (outputs.empty()) return {};
  if (outputs.size() == 1) return {{0, 0, area.width, area.height}};
  std::vector<TilePlace> best;
  const auto shown_px = [](const std::vector<TilePlace>& places) {
    double sum = 0;
    for (const TilePlace& place : places) sum += double(place.width) * place.height;
    return sum;
  };
  for (int rows = 1; rows <= static_cast<int>(outputs.size()); ++rows)
    if (std::vector<TilePlace> places = inRows(outputs, area, rows);
        best.empty() || shown_px(places) > shown_px(best))
      best = std::move(places);
  return best;
}

}  // namespace vps::viewer
