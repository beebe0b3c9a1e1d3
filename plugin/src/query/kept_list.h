// SPDX-License-Identifier: BSD-3-Clause
// How long a list of near pairs of two parts stays complete while they move.
#pragma once

#include <algorithm>
#include <cmath>

#include "vps/pose.h"

namespace vps::inline v0 {

/// A ball around a part, in the part's frame.
struct Ball {
  Vec3 center = Vec3::Zero();
  double radius_m = 0;
};

/// Upper bound of how far any point of the smaller ball moves relative to the other part between two poses of
/// part 1 in part 0: its centre's way, and its turn.
inline double travel_m(const Ball& ball0, const Ball& ball1, const Pose& X_01_start, const Pose& X_01_end) {
  const bool is_first = ball0.radius_m <= ball1.radius_m;
  const Ball& smaller = is_first ? ball0 : ball1;
  const Pose start = is_first ? X_01_start.inverse() : X_01_start;
  const Pose end = is_first ? X_01_end.inverse() : X_01_end;
  // 2 asin(|R - 1| / sqrt(8)): exact for a rotation, and above it by rounding only.
  const Mat3 turn = end.R * start.R.transpose();
  const double turn_rad = 2 * std::asin(std::min(1.0, (turn - Mat3::Identity()).norm() / std::sqrt(8.0)));
  return (end * smaller.center - start * smaller.center).norm() + turn_rad * smaller.radius_m;
}

/// A longer way is looked at in stretches of this length: else all pairs of fast parts would be near.
inline double longestStretch_m(const Ball& ball0, const Ball& ball1) {
  constexpr double kLeast_m = 100e-6, kOfRadius = 0.05;  // assumed
  return std::max(kLeast_m, kOfRadius * std::min(ball0.radius_m, ball1.radius_m));
}

/// By how much farther than needed to search, so that the list lasts for several steps of step_m each.
inline double searchMargin_m(double step_m, const Ball& ball0, const Ball& ball1) {
  // Slow parts are searched again when they have moved so far, fast ones every fourth step. assumed
  constexpr double kLeast_m = 100e-6, kLeastOfRadius = 0.015, kSteps = 4;
  const double radius_m = std::min(ball0.radius_m, ball1.radius_m);
  const double ahead_m =
      std::min(std::max(kSteps * step_m, kLeastOfRadius * radius_m), longestStretch_m(ball0, ball1));
  return 1.25 * step_m + std::max(kLeast_m, ahead_m);
}

}  // namespace vps::inline v0
