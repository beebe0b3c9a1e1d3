// SPDX-License-Identifier: BSD-3-Clause
// Play of a part, and the motions by which it can be removed.
#pragma once

#include <vector>

#include "motion/motion_search.h"

namespace vps::scenes {

/// The axes along and about which a part's play is measured.
struct PlayFrame {
  Mat3 axes_W = Mat3::Identity();
  Vec3 center_W = Vec3::Zero();
};

/// The axes of the part's frame through its centre of mass. If the part has a shaft or thread fit, the axes
/// are turned so that one of them is the axis of the longest fit, and the centre lies on this axis.
PlayFrame playFrame(const PlacedSurface& part, const std::vector<CheckedFit>& fits);

/// Play along or about an axis, forwards and backwards.
struct AxisPlay {
  std::array<double, 2> way = {};
  /// Error of each value of `way`: the error of the distance between the touching surfaces, divided by the
  /// rate at which they approach each other. (A shaft with a taper of 1:50 sinks by 100 times the error of
  /// its radius.) Infinite if the search ended before a contact was found; 0 if nothing stops the part.
  std::array<double, 2> error = {};
  bool is_given_up = false;  ///< the search ended before a contact was found; the play is greater
};

/// Measures play along (axis 0 to 2) or about (3 to 5) an axis of the frame.
/// @param leave_m a distance after which a part is certainly clear of all others
/// @param error_m error of the distance of surfaces that are near as drawn; at other contacts the chord error
/// of the two facets counts if it is more
AxisPlay playAlong(const MotionSearch& search, const PlayFrame& frame, int axis, double leave_m,
                   double error_m);

/// Unit directions in the world in which the part can be removed in a straight line. The search tries the
/// axes of the frame, the axes of the part's fits, and 42 directions all around.
std::vector<Vec3> waysOut(const MotionSearch& search, const PlacedSurface& part, const PlayFrame& frame,
                          const std::vector<CheckedFit>& fits, double leave_m);

/// Screw motions along the threads of the part's fits, in both directions, by which the part can be removed.
std::vector<ScrewWay> screwWaysOut(const MotionSearch& search, const PlacedSurface& part,
                                   const std::vector<CheckedFit>& fits, double leave_m);

}  // namespace vps::scenes
