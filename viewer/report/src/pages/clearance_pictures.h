// SPDX-License-Identifier: BSD-3-Clause
// Clearance as colours on the parts.
#pragma once

#include <array>
#include <string>

#include "vps_scenes/fits/check_types.h"

namespace vps::viewer {

/// sRGB, 0 to 1: magenta for an overlap, then from red over yellow and green to blue, by the logarithm of the
/// distance from a thousandth of near_m to near_m; light grey from there on.
std::array<double, 3> clearanceColor(double distance_m, double near_m);

/// A section of a page: each part from two sides, with the legend. Says what is missing where OpenGL is.
std::string clearancePictures(const scenes::CheckResult& result);

}  // namespace vps::viewer
