// SPDX-License-Identifier: BSD-3-Clause
// Tells how long a list of near pairs of two parts stays complete while the parts move.
#pragma once

#include <algorithm>
#include <cmath>

#include "query/motion/relative_motion.h"

namespace vps {

/// The expected motion of two parts, and a margin around it. A list of pairs that come near on this motion
/// stays complete as long as the parts follow it to within the margin. In a turning thread the features
/// within the length of a step are a hundred times as many as the features that come near on its motion.
class MotionTube {
 public:
  MotionTube() = default;

  /// Expects the motion from `start` to `end` to continue with the same twist for a few steps. Poses of part
  /// 1 in part 0.
  /// @param width  width of the margin, relative to the narrowest margin; see nextWidth()
  MotionTube(const Ball& ball0, const Ball& ball1, const Pose& start, const Pose& end, double width = 1)
      : ball0_(ball0), ball1_(ball1), width_(width) {
    // Assumed, by measurement on threads, gears and a heap: with a wider margin the list lasts longer, but
    // more pairs are near. The margin covers the error of the expectation, which does not grow with the step:
    // gears whose teeth roll on each other have steps of half a millimetre.
    constexpr double kLeast_m = 50e-6, kMost_m = 150e-6, kOfStep = 0.1;
    constexpr double kLongest = 24;
    const double step_m = travel_m(ball0, ball1, start, end);
    slack_m_ = width * std::clamp(kOfStep * step_m, kLeast_m, kMost_m);
    const double step_rad = MotionBetweenPoses(ball0, ball1, start, end).turn_rad();
    const double bend_m = bendOf(step_m, step_rad);
    double steps = kLongest;
    if (step_m > 0) steps = std::min(steps, 2 * longestStretch_m(ball0, ball1) / step_m);
    if (bend_m > 0) steps = std::min(steps, std::sqrt(0.5 * slack_m_ / bend_m));
    Pose to = end;
    const Pose once = start.inverse() * end;
    for (int k = 2; k <= static_cast<int>(steps); ++k) to = to * once;
    from_ = seen_ = start;
    to_ = to;
    way_ = MotionBetweenPoses(ball0, ball1, start, to);
    bend_m_ = bendOf(travel_m(ball0, ball1, start, to), way_.turn_rad());
  }

  /// As the constructor, but expects the parts to continue as they moved from their last pose, if the
  /// resulting tube holds `end` as well. The motion of a step that is not solved yet includes gravity and
  /// other loads that contacts will take.
  static MotionTube following(const Ball& ball0, const Ball& ball1, const Pose& last, const Pose& start,
                              const Pose& end, double width) {
    const Pose onward = start * (last.inverse() * start);
    if (travel_m(ball0, ball1, last, start) > 0) {
      const MotionTube tube(ball0, ball1, start, onward, width);
      if (tube.holds(start) && tube.holds(end)) return tube;
    }
    return {ball0, ball1, start, end, width};
  }

  /// The width for the next tube, if a search with this tube listed so many pairs. A wider tube lasts longer,
  /// but each pair of its list costs time in each step.
  [[nodiscard]] double nextWidth(std::size_t pairs) const {
    if (pairs < kFewPairs) return std::min(2 * width_, kWidest);
    return isTooWide(pairs) ? std::max(0.5 * width_, 1.0) : width_;
  }
  [[nodiscard]] bool isTooWide(std::size_t pairs) const { return width_ > 1 && pairs > kManyPairs; }
  /// Records the pose of part 1 in part 0.
  void see(const Pose& X_01) { seen_ = X_01; }
  /// The pose that was recorded last; at first the tube's first pose.
  [[nodiscard]] const Pose& seen() const { return seen_; }
  /// Poses of part 1 in part 0.
  [[nodiscard]] const Pose& from() const { return from_; }
  [[nodiscard]] const Pose& to() const { return to_; }
  /// While holds() is true for the ends of a motion, each point of a part near the other part is within this
  /// distance of the straight line from its place at from() to its place at to(), in the frame of the other
  /// part.
  [[nodiscard]] double margin_m() const { return slack_m_ + bend_m_; }
  /// Greatest turn from from() to a pose within the tube.
  [[nodiscard]] double turn_rad() const {
    return way_.turn_rad() + slack_m_ / std::min(ball0_.radius_m, ball1_.radius_m);
  }
  /// True if a pose of part 1 in part 0 is so near the expected motion that the motion between two such poses
  /// lies in the tube.
  [[nodiscard]] bool holds(const Pose& X_01) const {
    constexpr double kShare = 0.9;  // less than 1, because rotations are interpolated on a curved space
    const Pose nearest_10 = way_.at(way_.nearestShare(X_01));
    return travel_m(ball0_, ball1_, nearest_10.inverse(), X_01) <= kShare * slack_m_;
  }

 private:
  // Assumed, by measurement: a search takes as long as some thousand pairs.
  static constexpr std::size_t kFewPairs = 128, kManyPairs = 512;
  static constexpr double kWidest = 8;
  // How far a point leaves the straight line from its first to its last place, on a path of length way_m and
  // rotation turn_rad: an eighth of its second derivative. For a point of the smaller part, which turns about
  // its centre c, the derivative is turn^2 radius. For a point q of the larger part, seen from the smaller
  // one, R'(q - c) has at most turn^2 |q - c| + 2 turn |c'|, and q is near the smaller part.
  [[nodiscard]] double bendOf(double way_m, double turn_rad) const {
    const double radius_m = std::min(ball0_.radius_m, ball1_.radius_m);
    const double center_way_m = way_m - turn_rad * radius_m;  // see travel_m()
    return turn_rad * (turn_rad * (radius_m + slack_m_ + way_m) + 2 * center_way_m) / 8;
  }

  Ball ball0_, ball1_;
  Pose from_, to_;
  Pose seen_;
  MotionBetweenPoses way_;
  double width_ = 1;
  double slack_m_ = 0, bend_m_ = 0;
};

}  // namespace vps
