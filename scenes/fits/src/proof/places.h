// SPDX-License-Identifier: BSD-3-Clause
// Places beside those drawn at which no parts overlap.
#pragma once

#include "surface/placed_surface.h"
#include "vps/errors.h"

namespace vps::scenes {

/// See CheckedPlaces. Fits without more where nothing clashes.
///
/// Parts that clash with each other, over others that clash too, are looked at together. Moved is first one
/// of them alone, the smallest first, then all but the largest, then with them all that is near, last all of
/// them. The least motion that opens the gaps to first order is found, the overlap is measured exactly where
/// that leads to, and again, until no pair overlaps. The same bits on any number of threads.
/// @param checked  all pairs that are near each other, with their fits
CheckedPlaces freePlaces(const std::vector<PlacedSurface>& parts, const CheckResult& checked,
                         const Progress& progress);

}  // namespace vps::scenes
