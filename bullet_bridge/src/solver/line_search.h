// SPDX-License-Identifier: BSD-3-Clause
// The least value of a convex function along a step.
#pragma once

#include <algorithm>
#include <cmath>

#include "vps/contact_tolerances.h"

namespace vps::bullet {

/// How much of a step to take: 1, or the share at which the function is nearly least. The function is convex,
/// so its slope along the step increases; the minimum is where it is zero.
/// @param slope    at the start of the step; negative
/// @param slopeAt  the slope at a share of the step
template <typename SlopeAt>
double lineSearch(double slope, const SlopeAt& slopeAt) {
  double low = 0, low_slope = slope, high = 1, high_slope = slopeAt(1);
  if (high_slope <= -kAccuracyShare * slope) return 1;
  double share = 1;
  for (int k = 0; k < kMostPlaces; ++k) {
    const double room = high - low;
    share =
        std::clamp(low - low_slope * room / (high_slope - low_slope), low + 0.05 * room, high - 0.05 * room);
    const double here = slopeAt(share);
    if (std::abs(here) <= -kAccuracyShare * slope) break;
    (here < 0 ? low : high) = share;
    (here < 0 ? low_slope : high_slope) = here;
  }
  return share;
}

}  // namespace vps::bullet
