// SPDX-License-Identifier: BSD-3-Clause
// Proofs that a part cannot leave others on any path.
#pragma once

#include <cstddef>
#include <span>

#include "proof/pose_cover.h"
#include "surface/placed_surface.h"

namespace vps::scenes {

/// A box of motions that contains the drawn pose, and at whose border the part overlaps everywhere.
struct Enclosure {
  bool is_proven = false;  ///< no path leads from the drawn pose out of the box
  SixNumbers low = SixNumbers::Zero(), high = SixNumbers::Zero();  ///< the box [m, rad], about PoseSet::at_W
  std::size_t work = 0;                                            ///< in the unit of PoseCover::work
};

/// Proves that no path leads from the drawn pose of a part to places far from the obstacles, or proves
/// nothing.
///
/// The box of motions grows as long as a pose without overlap is found on one of its twelve faces. Once
/// coverPoses() proves that the part overlaps at every pose of every face, the drawn pose cannot be left
/// through them: poses without overlap that are connected to it lie within the box. Nothing is proven if the
/// box grows beyond the sizes of the parts, beyond rotations of half a radian, or if the work reaches its
/// limit. A part that is round about an axis does not need to be enclosed in rotations about this axis, since
/// they change nothing up to the error of the meshes, which Obstacle::error_m has to include.
/// @param round_axis_W unit vector of an axis through at_W about which the part is round; zero: none
Enclosure enclosureOf(const PartSurface& part, const Pose& X_WP, std::span<const Obstacle> obstacles,
                      const Vec3& at_W, const Vec3& round_axis_W, std::size_t most_work);

/// enclosureOf() for two parts as drawn: the one that is round, or else the smaller one, moves. Nothing is
/// proven for parts that overlap as drawn by more than the error of their meshes and a declared press fit.
Enclosure enclosureOfPair(const PlacedSurface& a, const PlacedSurface& b, std::size_t most_work);

}  // namespace vps::scenes
