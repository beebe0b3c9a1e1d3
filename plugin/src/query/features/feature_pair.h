// SPDX-License-Identifier: BSD-3-Clause
// The points of a pair of features, their nearest points, and the share of their way at which two moving
// features come near each other.
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
Nearest nearestPointsOfSegments(const Vec3& p1, const Vec3& q1, const Vec3& p2, const Vec3& q2);

/// Nearest points of two features.
/// @param a, b  corners of the features, from pointsOf(), in one frame
Nearest nearestOf(FeatureContact::Kind kind, const Vec3 (&a)[3], const Vec3 (&b)[3]);

/// Writes the corners of a feature in its part's own frame and returns their number.
/// @param i  part 0 or 1
int pointsOf(const FeatureSet& part, FeatureContact::Kind kind, int i, std::uint32_t feature, Vec3 (&out)[3]);

/// Points of a feature of part 0 and of part 1, in the frame of part 1. The points of part 0 move.
struct Features {
  Vec3 own[3];  ///< points of part 0, in its own frame
  Vec3 a[3], way[3], b[3];
  int a_count = 0, b_count = 0;

  void load(const FeatureSet& part0, const FeatureSet& part1, FeatureContact::Kind kind,
            const std::uint32_t (&feature)[2]) {
    a_count = pointsOf(part0, kind, 0, feature[0], own);
    b_count = pointsOf(part1, kind, 1, feature[1], b);
  }
  /// Sets the start and displacement of part 0's points between two poses of part 0 in part 1.
  void moveFrom(const Pose& from_10, const Pose& to_10) {
    for (int i = 0; i < a_count; ++i) {
      a[i] = from_10 * own[i];
      way[i] = to_10 * own[i] - a[i];
    }
  }
  void moveTo(double share, Vec3 (&at)[3]) const {
    for (int i = 0; i < a_count; ++i) at[i] = a[i] + share * way[i];
  }
};

/// The place at which features come within a distance.
struct Approach {
  double share = 0;
  Nearest nearest;
};

/// Returns false if the features stay farther apart than least_m. Otherwise `reach` is set to the place at
/// which they come within 1.1 times least_m, or to a place before it. Source: conservative advancement
/// (Mirtich 1996), here along the separating plane of the nearest points.
/// @param start_m  the features' distance at the start, positive
/// @param reach  holds the features' nearest points at the start
bool findApproach(FeatureContact::Kind kind, const Features& f, double least_m, double start_m,
                  Approach& reach);

}  // namespace vps
