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

/// Parts that move as one body: a single part, several parts that are pressed into each other, or all fixed
/// parts.
struct MovableBody {
  std::vector<std::size_t> parts;  ///< ascending
  bool is_fixed = false;
  /// Greatest allowed displacement of a corner of the parts' boxes: the tolerance of the body's tightest fit
  /// with another body.
  double allowed_m = 0;
  Box box_W;  ///< as drawn
  LooseBody loose;

  /// Greatest displacement of a corner of the body's box.
  [[nodiscard]] double mostMoved_m(const Eigen::Matrix<double, 6, 1>& motion) const;
  /// Greatest displacement of a corner of a box that moves with the body.
  [[nodiscard]] double mostMoved_m(const Eigen::Matrix<double, 6, 1>& motion, const Box& of_W) const;
  /// Upper bound of the rotation for which no corner moves by more than most_m [rad].
  [[nodiscard]] double mostTurn(double most_m) const;
};

/// The bodies of the parts. A part may move by the tolerance with which a run accepts it as in place: that of
/// its tightest fit with a part of another body, or kSightTolerance_m without such a fit.
std::vector<MovableBody> looseBodies(const std::vector<PlacedSurface>& parts, const CheckResult& checked);

/// The index of each part's body.
std::vector<std::size_t> bodyOfPart(const std::vector<MovableBody>& bodies, std::size_t part_count);

/// Searches for places without overlap; see CheckedPlaces. The verdict is Fits at once if no parts clash.
///
/// Parts that are connected by clashes form a group. The search moves first one part of a group alone (the
/// smallest first), then all parts but the largest, then these parts and all parts near them, and last the
/// whole group. The search finds the least motion that opens all gaps to first order, measures the overlap
/// exactly after this motion, and repeats until no pair overlaps. The result has the same bits on any number
/// of threads.
/// @param checked the check's result, with all near pairs and their fits
CheckedPlaces freePlaces(const std::vector<PlacedSurface>& parts, const CheckResult& checked,
                         const Progress& progress);

}  // namespace vps::scenes
