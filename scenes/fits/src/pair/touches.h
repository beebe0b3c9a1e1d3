// SPDX-License-Identifier: BSD-3-Clause
// Where two parts are in each other, as points of one and planes of the other.
#pragma once

#include <cstdint>
#include <vector>

#include "surface/placed_surface.h"

namespace vps::scenes {

/// A point of one part that is, or was, inside another, and the face of that one over which it leaves.
struct Touch {
  static constexpr std::uint32_t kNoVertex = 0xffffffff;
  std::size_t of = 0, above = 0;     ///< indices of the parts
  std::uint32_t vertex = kNoVertex;  ///< of the first part's mesh, if the point is one
  Vec3 p_O = Vec3::Zero();           ///< the point, in the frame of its part
  Vec3 q_A = Vec3::Zero();           ///< the nearest point of the other's surface, in the frame of that one
  Vec3 n_A = Vec3::UnitZ();          ///< its outward normal there, unit

  /// How high the point is above the plane.
  [[nodiscard]] double gap_m(const Pose& X_WO, const Pose& X_WA) const {
    return n_A.dot(X_WA.inverse() * (X_WO * p_O) - q_A);
  }
  /// Takes the plane anew where the point is inside of the other part.
  void renew(const PartSurface& above, const Pose& X_AO);
};

struct PairTouches {
  double depth_m = 0;  ///< by exact measure, as Overlap::depth_m
  std::vector<Touch> touches;
  std::size_t work = 0;  ///< as Overlap::work
};

/// The deepest point of two parts, and corners of each that are in the other by more than so much; of many
/// the deepest. O(corners in the other's box x log triangles).
PairTouches touchesOf(const std::vector<PlacedSurface>& parts, const std::vector<Pose>& X_WP, std::size_t a,
                      std::size_t b, double more_than_m);

}  // namespace vps::scenes
