// SPDX-License-Identifier: BSD-3-Clause
// Contacts of two overlapping parts, as points of one part and planes of the other.
#pragma once

#include <cstdint>
#include <vector>

#include "surface/placed_surface.h"

namespace vps::scenes {

/// A point of one part that is or was inside another part, and the plane of the other part's face through
/// which the point leaves.
struct Touch {
  static constexpr std::uint32_t kNoVertex = 0xffffffff;
  std::size_t of = 0, above = 0;     ///< indices of the part with the point and of the other part
  std::uint32_t vertex = kNoVertex;  ///< the point's index if it is a vertex of part `of`
  Vec3 p_O = Vec3::Zero();           ///< the point, in the frame of its part
  Vec3 q_A = Vec3::Zero();           ///< nearest point of the other part's surface, in the other part's frame
  Vec3 n_A = Vec3::UnitZ();          ///< outward normal of the other part's surface at q_A, unit

  /// Height of the point above the plane; negative below it.
  [[nodiscard]] double gap_m(const Pose& X_WO, const Pose& X_WA) const {
    return n_A.dot(X_WA.inverse() * (X_WO * p_O) - q_A);
  }
  /// Determines the plane anew if the point is inside the other part.
  void renew(const PartSurface& above, const Pose& X_AO);
};

/// The touches of a pair, and its depth.
struct PairTouches {
  double depth_m = 0;  ///< depth by exact measure, as Overlap::depth_m
  std::vector<Touch> touches;
  std::size_t work = 0;  ///< work that was done, in the unit of Overlap::work
};

/// Finds the touches of two parts: the deepest point, and the corners of each part that are deeper than
/// more_than_m in the other part (at most the 64 deepest). O(corners in the other part's box x log
/// triangles).
PairTouches touchesOf(const std::vector<PlacedSurface>& parts, const std::vector<Pose>& X_WP, std::size_t a,
                      std::size_t b, double more_than_m);

}  // namespace vps::scenes
