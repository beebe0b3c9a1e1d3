// SPDX-License-Identifier: BSD-3-Clause
// The points of a pair of features, and the nearest points of two features.
#pragma once

#include <cstdint>

#include "vps/feature_motion.h"

namespace vps {

/// The nearest points of two features.
struct Nearest {
  Vec3 p = Vec3::Zero(), q = Vec3::Zero();  ///< on part 0, on part 1
  /// If the feature is an edge: the end, 0 or 1, at which its nearest point lies.
  std::int8_t end[2] = {kBetween, kBetween};
  static constexpr std::int8_t kBetween = -1;

  [[nodiscard]] double distance_m() const { return (p - q).norm(); }
};

/// Nearest points of the segments from p1 to q1 and from p2 to q2. Source: Ericson 2005, section 5.1.9.
Nearest nearestOfSegments(const Vec3& p1, const Vec3& q1, const Vec3& p2, const Vec3& q2);

/// Nearest points of two features.
/// @param a, b  corners of the features, from pointsOf(), in one frame
Nearest nearestOf(FeatureContact::Kind kind, const Vec3 (&a)[3], const Vec3 (&b)[3]);

/// Writes the corners of a feature in its part's own frame and returns their number.
/// @param i  part 0 or 1
int pointsOf(const FeatureSet& part, FeatureContact::Kind kind, int i, std::uint32_t feature, Vec3 (&out)[3]);

}  // namespace vps
