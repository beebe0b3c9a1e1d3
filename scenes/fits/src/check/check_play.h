// SPDX-License-Identifier: BSD-3-Clause
// Play and ways out of all parts.
#pragma once

#include "surface/placed_surface.h"

namespace vps::scenes {

/// Fills play and ways out of result.parts, which follows the order of `parts`; pairs and fits are there
/// already. On all cores; the progress is told on the caller's thread.
void checkPlay(const std::vector<PlacedSurface>& parts, CheckResult& result, const CheckSettings& settings,
               const Progress& progress);

}  // namespace vps::scenes
