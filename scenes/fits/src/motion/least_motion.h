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

/// A body that may move, about a point of it.
struct LooseBody {
  Vec3 at_W = Vec3::Zero();  ///< in the middle of the body as drawn
  double arm_m = 0;          ///< half of its diagonal: a turn counts as this far
  double most_m = 0;         ///< none of its six numbers should be more than this
};

/// A point of one body and the plane of the other that it is to stay above.
struct GapRow {
  static constexpr std::size_t kHeld = std::numeric_limits<std::size_t>::max();
  std::size_t of = kHeld, above = kHeld;  ///< indices of bodies; kHeld: it does not move
  Vec3 p_W = Vec3::Zero();                ///< the point
  Vec3 n_W = Vec3::UnitZ();               ///< outward normal of the plane, unit
  double gap_m = 0;                       ///< height of the point above the plane; negative below
};

/// Six numbers for each body: how far its middle has moved [m], and the rotation vector [rad] by arm_m [m].
using Motions = Eigen::VectorXd;

/// The e of leastMotion() for a search: a millionth of the motion is far below what depths are measured to.
inline constexpr double kSearchMotionCost = 1e-6;

/// The motions for which no gap is negative, to first order, and of these the least in the sum of squares. If
/// there are none, those with the least sum of squares of the negative gaps. What a motion is beyond most_m
/// counts as a negative gap.
///
/// Minimises e |x|^2 / 2 + sum min(0, gap)^2 / 2 by Newton's method on the gaps that are closed, which ends
/// in finitely many steps; e is so small that what it leaves open is a millionth of the motion.
/// @param from    where the gaps of the rows were measured
/// @param closed_m  receives by row how far its gap stays negative, 0 for the others
/// O(rows + bodies^3) a step.
Motions leastMotion(std::span<const GapRow> rows, std::span<const LooseBody> bodies, const Motions& from,
                    double e, std::vector<double>& closed_m);

/// The pose after a motion of the body that stands at X_WP when all six numbers are 0.
Pose movedPose(const Pose& X_WP, const LooseBody& body, const Eigen::Matrix<double, 6, 1>& motion);

}  // namespace vps::scenes
