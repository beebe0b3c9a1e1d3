// SPDX-License-Identifier: BSD-3-Clause
// How far a part may be from its place where its step gives no tolerance: for the plan and for the verdict.
#pragma once

#include <algorithm>

namespace vps::scenes {

/// Greatest tolerance that a fit gives, but for its own play. assumed: a usual tolerance of position
inline constexpr double kFitTolerance_m = 0.1e-3;
/// Tolerance of what sight alone stops: five standard deviations of device::OperatorHabits::see_error_m.
inline constexpr double kSightTolerance_m = 0.5e-3;
/// Added to the clearance of a fit: 10 um count as contact, and a part may touch on both sides.
inline constexpr double kContactOnBothSides_m = 20e-6;

/// What a fit of this clearance allows; an overlap as none. A part in a loose rectangular hole may lie in its
/// corner, off by half of the clearance in both directions: it is home as far as the fit can tell.
inline double fitTolerance_m(double diametral_clearance_m) {
  const double clearance_m = std::max(0.0, diametral_clearance_m);
  constexpr double kToCorner = 0.70710678118654752;  // half of the square root of two
  const double play_m = std::min(kSightTolerance_m, kToCorner * clearance_m + kContactOnBothSides_m);
  return std::max(std::min(kFitTolerance_m, clearance_m + kContactOnBothSides_m), play_m);
}

}  // namespace vps::scenes
