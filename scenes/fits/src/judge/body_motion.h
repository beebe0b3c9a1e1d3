// SPDX-License-Identifier: BSD-3-Clause
// How a body moves within one step, how far two bodies can move against each other meanwhile, and how far a
// displacement takes the points of a part.
#pragma once

#include <algorithm>

#include "vps/box.h"
#include "vps/mesh.h"
#include "vps/pose.h"
#include "vps/solid.h"

namespace vps::scenes {

/// The motion of a rigid body in one step: its centre of mass moves along a line, and the body turns about
/// its centre of mass, both uniformly. The rotation is the shorter of the two possible ones, so the body
/// turns by less than half a turn.
class BodyMotion {
 public:
  /// A body at rest.
  explicit BodyMotion(const Pose& X_WP) : X_0_(X_WP), center_W_(X_WP.p) {}
  /// @param center_P  centre of mass in the part's frame
  BodyMotion(const Pose& X_0, const Pose& X_1, const Vec3& center_P);

  [[nodiscard]] Pose at(double share) const;
  [[nodiscard]] const Pose& start() const { return X_0_; }
  [[nodiscard]] const Vec3& centerStart_W() const { return center_W_; }
  [[nodiscard]] const Vec3& way_W() const { return way_W_; }    ///< displacement of the centre of mass
  [[nodiscard]] const Vec3& turn_W() const { return turn_W_; }  ///< rotation vector

 private:
  Pose X_0_;
  Vec3 center_W_, way_W_ = Vec3::Zero(), turn_W_ = Vec3::Zero();
};

/// Bounds of the motion of two bodies relative to each other.
struct RelativeMotion {
  /// Upper bound of the path length of any point of one body in the frame of the other body. No depth and no
  /// gap changes by more than this length.
  double travel_m = 0;
  /// Upper bound of the distance between the path of any point of b, in the frame of a, and the chord of that
  /// path.
  double sagitta_m = 0;
};
/// Bounds the relative motion of two bodies.
/// @param box_A, box_B boxes of the bodies, in their frames
RelativeMotion relativeMotion(const BodyMotion& a, const Box& box_A, const BodyMotion& b, const Box& box_B);

/// Greatest displacement of any point of a box that moves from X_a to X_b. A corner has the greatest
/// displacement, since the displacement is a convex function of the point.
inline double greatestDisplacement(const Box& box, const Pose& X_a, const Pose& X_b) {
  double greatest_m = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1) ? box.max.x() : box.min.x(), (corner & 2) ? box.max.y() : box.min.y(),
                 (corner & 4) ? box.max.z() : box.min.z());
    greatest_m = std::max(greatest_m, (X_b * p - X_a * p).norm());
  }
  return greatest_m;
}

/// Greatest distance of a vertex of a displaced part from the surface of the part at its place [m]. A
/// displacement that maps the surface to itself, such as the turn of a round peg about its axis, gives 0. O(n
/// log n).
/// @param X_error pose of the displaced part relative to its place
double surfaceError_m(const Solid& solid, const Pose& X_error);

}  // namespace vps::scenes
