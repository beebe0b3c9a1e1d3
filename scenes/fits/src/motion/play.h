// SPDX-License-Identifier: BSD-3-Clause
// Play of a part, and the ways on which it leaves.
#pragma once

#include <vector>

#include "motion/motion_search.h"

namespace vps::scenes {

/// The axes along and about which a part's play is measured.
struct PlayFrame {
  Mat3 axes_W = Mat3::Identity();
  Vec3 center_W = Vec3::Zero();
};

/// The part's own axes through its centre of mass. With fits, the axis of the longest is one of them, and the
/// centre is on it.
PlayFrame playFrame(const PlacedSurface& part, const std::vector<CheckedFit>& fits);

/// Play along or about an axis, forwards and back.
struct AxisPlay {
  std::array<double, 2> way = {};
  /// Of each way, by that of the distance between the surfaces where they touch: that divided by the rate at
  /// which they come nearer. A shaft with a taper of 1:50 sinks by 100 times the radius that it lacks.
  /// Infinite where the search ended before the play did; 0 where nothing stops it.
  std::array<double, 2> error = {};
  bool is_given_up = false;  ///< the search ended before the play did, which is more
};

/// Along (0 to 2) or about (3 to 5) an axis of the frame.
/// @param leave_m  a way on which a part certainly leaves all others
/// @param error_m  of the distance of surfaces that are near as drawn; elsewhere the facets' own chord counts
AxisPlay playAlong(const MotionSearch& search, const PlayFrame& frame, int axis, double leave_m,
                   double error_m);

/// Unit directions in the world in which the part leaves the others on a straight line: of the frame's axes,
/// of those of its fits, and of 42 directions all around.
std::vector<Vec3> waysOut(const MotionSearch& search, const PlacedSurface& part, const PlayFrame& frame,
                          const std::vector<CheckedFit>& fits, double leave_m);

/// Screws along the threads of its fits, both ways, on which the part leaves the others.
std::vector<ScrewWay> screwWaysOut(const MotionSearch& search, const PlacedSurface& part,
                                   const std::vector<CheckedFit>& fits, double leave_m);

}  // namespace vps::scenes
