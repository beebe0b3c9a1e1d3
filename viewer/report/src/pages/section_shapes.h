// SPDX-License-Identifier: BSD-3-Clause
// Shapes of which the SVG pictures of sections are made: outlines, scale bars, keys.
#pragma once

#include <array>
#include <string>

#include "vps_scenes/fits/check_types.h"

namespace vps::viewer::svg {

using Point = std::array<double, 2>;

inline constexpr double kSide = 440, kGap = 30, kTop = 6, kFoot = 34;  // [px]

/// A rectangle on the page that shows a part of a section, at the same scale in both directions.
struct Window {
  Point middle_m{};                      ///< of the shown region, in the section
  double half_m = 0, left = 0;           ///< half the width of the region; left edge on the page [px]
  double width = kSide, height = kSide;  ///< on the page [px]

  [[nodiscard]] double scale() const { return width / (2 * half_m); }
  [[nodiscard]] Point toPixel(const Point& p) const {
    return {left + (p[0] - middle_m[0] + half_m) * scale(),
            kTop + 0.5 * height + (middle_m[1] - p[1]) * scale()};
  }
};

/// An outline as an SVG path. Points nearer than a third of a pixel to the previous point are left out.
std::string pathOf(const scenes::SectionOutline& outline, const Window& window);

std::string text(double x, double y, const std::string& words, const char* anchor = "start");
/// A bar of a round length below the window, with its length.
std::string scaleBar(const Window& window);
/// @param style attributes of the element: fill and stroke
std::string rectangle(double x, double y, double w, double h, const char* style);
/// A filled path with a thin border.
/// @param more further attributes
std::string filled(const std::string& path, const std::string& fill, const std::string& more = {});
/// A coloured square with words, for the list of colours below a picture.
std::string key(double x, double y, const char* fill, const std::string& words);

}  // namespace vps::viewer::svg
