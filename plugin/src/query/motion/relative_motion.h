// SPDX-License-Identifier: BSD-3-Clause
// The relative motion of two parts between two poses.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "vps/contact_tolerances.h"
#include "vps/feature_motion.h"
#include "vps/pose.h"

namespace vps {

/// A ball around a part, in the part's frame.
struct Ball {
  Vec3 center = Vec3::Zero();
  double radius_m = 0;
};

/// Upper bound of how far any point of the smaller ball moves relative to the other part between two poses of
/// part 1 in part 0: its centre's path length plus the rotation's share.
inline double travel_m(const Ball& ball0, const Ball& ball1, const Pose& X_01_start, const Pose& X_01_end) {
  const bool is_first = ball0.radius_m <= ball1.radius_m;
  const Ball& smaller = is_first ? ball0 : ball1;
  const Pose start = is_first ? X_01_start.inverse() : X_01_start;
  const Pose end = is_first ? X_01_end.inverse() : X_01_end;
  // 2 asin(|R - 1| / sqrt(8)): exact for a rotation up to rounding.
  const Mat3 turn = end.R * start.R.transpose();
  const double turn_rad = 2 * std::asin(std::min(1.0, (turn - Mat3::Identity()).norm() / std::sqrt(8.0)));
  return (end * smaller.center - start * smaller.center).norm() + turn_rad * smaller.radius_m;
}

/// Length of the segments into which a longer motion is divided; without them all pairs of fast parts would
/// be near.
inline double longestStretch_m(const Ball& ball0, const Ball& ball1) {
  constexpr double kLeast_m = 100e-6, kOfRadius = 0.05;  // assumed
  return std::max(kLeast_m, kOfRadius * std::min(ball0.radius_m, ball1.radius_m));
}

/// The motion between two poses of part 1 in part 0: the smaller part's centre moves on a straight line in
/// the other part's frame, and the smaller part turns at a constant rate.
class MotionBetweenPoses {
 public:
  MotionBetweenPoses() = default;
  MotionBetweenPoses(const Ball& ball0, const Ball& ball1, const Pose& start_01, const Pose& end_01)
      : is_first_(ball0.radius_m <= ball1.radius_m),
        from_(is_first_ ? start_01.inverse() : start_01),
        to_(is_first_ ? end_01.inverse() : end_01),
        turn_(rotationVector(to_.R * from_.R.transpose())),
        center_(is_first_ ? ball0.center : ball1.center),
        radius_m_(is_first_ ? ball0.radius_m : ball1.radius_m) {}

  /// Pose of part 0 in part 1 after this share of the motion.
  [[nodiscard]] Pose at(double share) const {
    Pose X = share < 1 ? from_ : to_;
    if (share > 0 && share < 1) {
      X.R = rotationFromVector(share * turn_) * from_.R;
      X.p = centerAt(share) - X.R * center_;
    }
    return is_first_ ? X : X.inverse();
  }

  /// Poses of part 0 in part 1 between which vertices move on nearly straight lines.
  void divide(std::vector<Pose>& way_10) const {
    // The fraction of the rest gap that FeatureMotion::check() allows.
    constexpr double kMost_m = (1 - FeatureMotion::kLeastShare) * FeatureMotion::kRest_m;
    const double sagitta_m = turn_.squaredNorm() * radius_m_ / 8;
    const int pieces =
        static_cast<int>(std::clamp(std::ceil(std::sqrt(sagitta_m / kMost_m)), 1.0, kMostStretches));
    way_10.clear();
    for (int k = 0; k <= pieces; ++k) way_10.push_back(at(static_cast<double>(k) / pieces));
  }

  /// The share at which this motion is nearest to a pose of part 1 in part 0, as the smaller part moves.
  [[nodiscard]] double nearestShare(const Pose& X_01) const {
    const Pose X = is_first_ ? X_01.inverse() : X_01;
    const Vec3 moved = X * center_ - centerAt(0), way = centerAt(1) - centerAt(0);
    const Vec3 turned = radius_m_ * rotationVector(X.R * from_.R.transpose()), turn = radius_m_ * turn_;
    const double square = way.squaredNorm() + turn.squaredNorm();
    return square > 0 ? std::clamp((moved.dot(way) + turned.dot(turn)) / square, 0.0, 1.0) : 0;
  }

  [[nodiscard]] double turn_rad() const { return turn_.norm(); }

 private:
  [[nodiscard]] Vec3 centerAt(double share) const {
    const Vec3 start = from_ * center_;
    return start + share * (to_ * center_ - start);
  }

  bool is_first_ = true;
  Pose from_, to_;  // poses of the smaller part in the other part
  Vec3 turn_ = Vec3::Zero(), center_ = Vec3::Zero();
  double radius_m_ = 0;
};

}  // namespace vps
