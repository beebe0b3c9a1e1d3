// SPDX-License-Identifier: BSD-3-Clause
#include "judge/body_motion.h"

#include <algorithm>
#include <cmath>

namespace vps::scenes {

namespace {

/// Bounds the motion of the points of b in the frame of a. Let v be the relative velocity at the middle of
/// b's box at the start of the step, and w the relative angular velocity. A point at r from the middle moves
/// at v + w x r. During the step, v changes by b's turn about its centre of mass and by a's turn.
RelativeMotion pointsIn(const BodyMotion& a, const BodyMotion& b, const Box& box_B) {
  const double radius_m = 0.5 * box_B.size().norm();
  const Vec3 middle_W = b.start() * box_B.center();
  const Vec3 from_b = middle_W - b.centerStart_W(), from_a = middle_W - a.centerStart_W();
  const double turn_a = a.turn_W().norm(), turn_b = b.turn_W().norm();
  const Vec3 v = b.way_W() + b.turn_W().cross(from_b) - a.way_W() - a.turn_W().cross(from_a);
  const double in_b_m = turn_b * from_b.norm();
  const double change_m = turn_b * in_b_m + turn_a * ((b.way_W() - a.way_W()).norm() + in_b_m);
  RelativeMotion motion;
  motion.travel_m = v.norm() + 0.5 * change_m + (b.turn_W() - a.turn_W()).norm() * radius_m;
  // The terms are b's centripetal acceleration, and the Coriolis and centripetal accelerations of a's frame.
  // A path with acceleration c over a unit time deviates from its chord by c / 8.
  const double away_m = from_a.norm() + radius_m + motion.travel_m;
  motion.sagitta_m = (turn_b * turn_b * (from_b.norm() + radius_m) + 2 * turn_a * motion.travel_m +
                      turn_a * turn_a * away_m) /
                     8;
  return motion;
}

}  // namespace

BodyMotion::BodyMotion(const Pose& X_0, const Pose& X_1, const Vec3& center_P)
    : X_0_(X_0),
      center_W_(X_0 * center_P),
      way_W_(X_1 * center_P - center_W_),
      turn_W_(rotationVector(X_1.R * X_0.R.transpose())) {}

Pose BodyMotion::at(double share) const {
  const Mat3 R = rotationFromVector(share * turn_W_) * X_0_.R;
  const Vec3 from_center_P = X_0_.R.transpose() * (X_0_.p - center_W_);
  return {R, Vec3(center_W_ + share * way_W_ + R * from_center_P)};
}

RelativeMotion relativeMotion(const BodyMotion& a, const Box& box_A, const BodyMotion& b, const Box& box_B) {
  RelativeMotion of_b = pointsIn(a, b, box_B);
  of_b.travel_m = std::min(of_b.travel_m, pointsIn(b, a, box_A).travel_m);
  return of_b;
}

double surfaceError_m(const Solid& solid, const Pose& X_error) {
  double greatest_m = 0;
  for (const Vec3& p : solid.mesh().vertices)
    greatest_m = std::max(greatest_m, std::abs(solid.signedDistance(X_error * p)));
  return greatest_m;
}

}  // namespace vps::scenes
