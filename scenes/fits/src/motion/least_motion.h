// SPDX-License-Identifier: BSD-3-Clause
// The least rigid motion of some bodies that opens the gaps between them.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "vps/pose.h"

namespace vps::scenes {

/// A body that may move; it turns about the point at_W.
struct LooseBody {
  Vec3 at_W = Vec3::Zero();  ///< point in the middle of the body as drawn
  double arm_m = 0;   ///< half of the body's diagonal, by which a rotation is multiplied to give a length
  double most_m = 0;  ///< limit of each of the body's six numbers
};

/// A point of one body and a plane of another one. The point should stay above the plane.
struct GapRow {
  static constexpr std::size_t kHeld = std::numeric_limits<std::size_t>::max();
  /// Indices of the bodies of point and plane; kHeld: that body does not move.
  std::size_t of = kHeld, above = kHeld;
  Vec3 p_W = Vec3::Zero();   ///< the point
  Vec3 n_W = Vec3::UnitZ();  ///< outward normal of the plane, unit
  double gap_m = 0;          ///< height of the point above the plane; negative below
};

/// Six numbers for each body: the displacement of its middle [m], and its rotation vector [rad] times arm_m
/// [m].
using Motions = Eigen::VectorXd;

/// The parameter e of leastMotion() for a search. This value leaves an error of a millionth of the motion,
/// far below the precision of depths.
inline constexpr double kSearchMotionCost = 1e-6;

/// The motion with the least sum of squares for which no gap is negative, to first order. If no such motion
/// exists, the result has the least sum of squares of the negative gaps. The amount by which a number of a
/// motion exceeds most_m counts as a negative gap.
///
/// Minimises e |x|^2 / 2 + sum min(0, gap)^2 / 2 by Newton's method on the negative gaps, which ends after
/// finitely many steps. A gap stays negative by about e times the motion. O(rows + bodies^3) for each step of
/// Newton's method.
/// @param from motions at which the gaps of the rows were measured
/// @param closed_m receives for each row the amount by which its gap stays negative, else 0
Motions leastMotion(std::span<const GapRow> rows, std::span<const LooseBody> bodies, const Motions& from,
                    double e, std::vector<double>& closed_m);

/// A rigid motion of one part or body, in the world: the displacement of a point at_W [m], then the rotation
/// vector about that point [rad] (of a LooseBody: times arm_m [m]).
using SixNumbers = Eigen::Matrix<double, 6, 1>;

/// The pose of a part after a motion.
Pose poseAfter(const Pose& X_WP, const Vec3& at_W, const SixNumbers& motion);

/// The pose after a motion, for a part of the body whose pose is X_WP if all six numbers are 0.
Pose movedPose(const Pose& X_WP, const LooseBody& body, const SixNumbers& motion);

}  // namespace vps::scenes
