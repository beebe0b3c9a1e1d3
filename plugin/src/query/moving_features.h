// SPDX-License-Identifier: BSD-3-Clause
// Two features that move on straight lines, and the share of their way at which they come near each other.
#pragma once

#include "query/feature_points.h"

namespace vps {

/// Points of a feature of part 0 and of part 1, in the frame of part 1. The points of part 0 move.
struct Features {
  Vec3 own[3];  ///< of part 0, in its own frame
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
struct Reach {
  double share = 0;
  Nearest nearest;
};

/// Returns false if the features stay farther apart than least_m. Otherwise `reach` is set to the place at
/// which they come within 1.1 times least_m, or to a place before it. Source: conservative advancement
/// (Mirtich 1996), here along the separating plane of the nearest points.
/// @param start_m  the features' distance at the start, positive
/// @param reach  holds the features' nearest points at the start
bool findReach(FeatureContact::Kind kind, const Features& f, double least_m, double start_m, Reach& reach);

}  // namespace vps
