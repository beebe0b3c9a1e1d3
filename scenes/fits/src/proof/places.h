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

/// What a fit with another body allows a body: the ends of the fit's length stay within most_m of where they
/// are drawn, across the axis of a shaft or across the faces of a key. Along its axis and about it a shaft is
/// free, and a key along its faces. An end is where the play is least, so that a long part in a short slot
/// may swing as far as the slot lets it.
struct FitLimit {
  std::array<Vec3, 2> ends_W;
  Vec3 axis_W = Vec3::UnitZ();  ///< axis of a shaft or normal of a key's faces; unit
  bool is_key = false;
  double most_m = 0;  ///< fitTolerance_m()

  /// The part of an end's displacement that the fit limits.
  [[nodiscard]] Vec3 limited(const Vec3& by_W) const {
    const Vec3 along_W = axis_W * axis_W.dot(by_W);
    return is_key ? along_W : Vec3(by_W - along_W);
  }
};

/// Parts that move as one body: a single part, several parts that are pressed into each other, or all fixed
/// parts.
struct MovableBody {
  std::vector<std::size_t> parts;  ///< ascending
  bool is_fixed = false;
  /// Greatest allowed displacement of a corner of the parts' boxes: kSightTolerance_m; 0 for a fixed body.
  double allowed_m = 0;
  std::vector<FitLimit> limits;  ///< of the body's fits with other bodies
  Box box_W;                     ///< as drawn
  LooseBody loose;

  /// Greatest displacement of a corner of the body's box.
  [[nodiscard]] double mostMoved_m(const Eigen::Matrix<double, 6, 1>& motion) const;
  /// Greatest displacement of a corner of a box that moves with the body.
  [[nodiscard]] double mostMoved_m(const Eigen::Matrix<double, 6, 1>& motion, const Box& of_W) const;
  /// Whether the motion is within allowed_m and within the limits of all fits.
  [[nodiscard]] bool allows(const Eigen::Matrix<double, 6, 1>& motion) const;
  /// Appends rows of leastMotion() that keep the ends of all fits within their limits.
  /// @param variable  the body's index among the bodies that move
  /// @param motion    the motion at which the rows are made
  void appendLimits(std::size_t variable, const Eigen::Matrix<double, 6, 1>& motion,
                    std::vector<GapRow>& rows) const;
  /// Upper bound of the rotation for which no corner moves by more than most_m [rad].
  [[nodiscard]] double mostTurn(double most_m) const;
};

/// The bodies of the parts. A part may move as far as a run accepts it as in place: by kSightTolerance_m, and
/// in each of its fits with parts of other bodies by the tolerance of that fit.
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
