// SPDX-License-Identifier: BSD-3-Clause
// The distance of surfaces from other parts, point by point, for pictures.
#pragma once

#include <vector>

#include "surface/placed_surface.h"

namespace vps::scenes {

/// Of each part that has another one within near_m, the parts with the tightest places first. On all cores.
std::vector<ClearanceMap> clearanceMaps(const std::vector<PlacedSurface>& parts, const CheckResult& result,
                                        double near_m, const Progress& progress);

}  // namespace vps::scenes
