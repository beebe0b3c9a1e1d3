// SPDX-License-Identifier: BSD-3-Clause
// How far a part may be from its place where its step gives no tolerance: for the plan and for the verdict.
#pragma once

#include <algorithm>

namespace vps::scenes::inline v0 {

/// Greatest tolerance that a fit gives. assumed: a usual tolerance of position
inline constexpr double kFitTolerance_m = 0.1e-3;
/// Tolerance of what sight alone stops: five standard deviations of device::OperatorHabits::see_error_m.
inline constexpr double kSightTolerance_m = 0.5e-3;
/// Added to the clearance of a fit: 10 um count as contact, and a part may touch on both sides.
inline constexpr double kContactOnBothSides_m = 20e-6;

/// What a fit of this clearance allows; an overlap as none.
inline double fitTolerance_m(double diametral_clearance_m) {
  return std::min(kFitTolerance_m, std::max(0.0, diametral_clearance_m) + kContactOnBothSides_m);
}

}  // namespace vps::scenes::inline v0
