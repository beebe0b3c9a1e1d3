// SPDX-License-Identifier: BSD-3-Clause
// A check of parts that are prepared already.
#pragma once

#include "surface/placed_surface.h"

namespace vps::scenes {

/// As checkAssembly().
CheckResult checkPlaced(const std::string& name, const std::vector<PlacedSurface>& placed,
                        const CheckSettings& settings, const Progress& progress);

}  // namespace vps::scenes
