// SPDX-License-Identifier: BSD-3-Clause
// Proofs that a part overlaps others at every pose of a set of poses.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "motion/least_motion.h"
#include "surface/part_surface.h"

namespace vps::scenes {

/// A part at rest.
struct Obstacle {
  const PartSurface* surface = nullptr;
  Pose X_WP;
  /// Overlaps up to this depth do not count: the error of the pair's meshes and the drawn overlap that is
  /// allowed.
  double error_m = 0;
};

/// A set of poses: all motions between center - half and center + half at which no corner of a box moves
/// farther than most_m.
struct PoseSet {
  Vec3 at_W = Vec3::Zero();
  SixNumbers center = SixNumbers::Zero(), half = SixNumbers::Zero();
  Box box_W;          ///< moves with the part; empty: no limit
  double most_m = 0;  ///< limit of the corners' displacements from the drawn place
};

struct PoseCover {
  bool is_proven = false;  ///< at every pose of the set, the part overlaps an obstacle by more than its error
  /// A motion of the set at which no overlap deeper than the error was found, if the search met one.
  std::optional<SixNumbers> free;
  std::size_t cells = 0;  ///< cells that were examined
  std::size_t work = 0;   ///< distance queries, each of about a microsecond
};

/// Proves that a part overlaps some obstacle at every pose of a set, or finds a pose at which it does not.
///
/// The set is divided into cells, boxes of motions. Points of both surfaces have gaps to the other solid;
/// over one cell each gap is at most a linear function of the motion plus a remainder (PointAtSolid::bound(),
/// and the terms of second order of the rotation). If a weighted mean of these bounds is negative for all
/// motions of the cell, then at each motion at least one gap is negative: the cell is proven (Farkas' lemma,
/// with remainders). Otherwise the cell is halved. Cells that are likely to hold a free pose come first. At
/// the middle of each cell that is not proven, the overlap is measured exactly; a deepest point that no
/// sample shows becomes a sample. Deterministic.
///
/// Nothing is proven for surfaces that are not closed. Rotations of the set are limited to about 0.6 rad;
/// nothing is proven for larger ones.
/// @param most_work limit of PoseCover::work
PoseCover coverPoses(const PartSurface& part, const Pose& X_WP, std::span<const Obstacle> obstacles,
                     const PoseSet& set, std::size_t most_work);

}  // namespace vps::scenes
