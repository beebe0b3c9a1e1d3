// SPDX-License-Identifier: BSD-3-Clause
// The points of a pair of features, and where two features are nearest.
#pragma once

#include <cstdint>

#include "vps/feature_motion.h"

namespace vps {

/// The nearest points of two features.
struct Nearest {
  Vec3 p = Vec3::Zero(), q = Vec3::Zero();  ///< on part 0, on part 1
  /// Of two edges: that end of each, 0 or 1, at which its point is.
  std::int8_t end[2] = {kBetween, kBetween};
  static constexpr std::int8_t kBetween = -1;

  [[nodiscard]] double distance_m() const { return (p - q).norm(); }
};

/// Of the segments from p1 to q1 and from p2 to q2. Source: Ericson 2005, section 5.1.9.
Nearest nearestOfSegments(const Vec3& p1, const Vec3& q1, const Vec3& p2, const Vec3& q2);

/// @param a, b  corners of the features, as pointsOf() gives them, in one frame
Nearest nearestOf(FeatureContact::Kind kind, const Vec3 (&a)[3], const Vec3 (&b)[3]);

/// The corners of a feature in its part's own frame. Returns how many it has.
/// @param i  part 0 or 1
int pointsOf(const FeatureSet& part, FeatureContact::Kind kind, int i, std::uint32_t feature, Vec3 (&out)[3]);

}  // namespace vps
