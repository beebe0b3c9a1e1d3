// SPDX-License-Identifier: BSD-3-Clause
// Bodies that may be moved to clear an overlap, and places near the drawn ones at which no parts overlap.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "motion/least_motion.h"
#include "surface/placed_surface.h"
#include "vps/errors.h"

namespace vps::scenes {

/// Parts that move as one: one part, or several that are pressed into each other, or all that are fixed.
struct MovableBody {
  std::vector<std::size_t> parts;  ///< ascending
  bool is_fixed = false;
  /// No corner of the parts' boxes may go farther: the tolerance of its tightest fit with another body.
  double allowed_m = 0;
  Box box_W;  ///< as drawn
  LooseBody loose;

  /// How far the corner of its boxes that goes farthest goes.
  [[nodiscard]] double mostMoved_m(const Eigen::Matrix<double, 6, 1>& motion) const;
  /// The same of a box that moves with it.
  [[nodiscard]] double mostMoved_m(const Eigen::Matrix<double, 6, 1>& motion, const Box& of_W) const;
  /// No turn for which every corner goes no farther than most_m is more than this [rad].
  [[nodiscard]] double mostTurn(double most_m) const;
};

/// The bodies of the parts. What a part may move by is the tolerance with which a run takes it to be in
/// place: of its tightest fit with a part of another body, or of sight where it has none.
std::vector<MovableBody> looseBodies(const std::vector<PlacedSurface>& parts, const CheckResult& checked);

/// The body of each part.
std::vector<std::size_t> bodyOfPart(const std::vector<MovableBody>& bodies, std::size_t part_count);

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
