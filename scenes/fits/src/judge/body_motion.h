// SPDX-License-Identifier: BSD-3-Clause
// How a body moves within one step, and how far two bodies can move against each other meanwhile.
#pragma once

#include "vps/box.h"
#include "vps/pose.h"

namespace vps::scenes {

/// The motion of a rigid body in one step: its centre of mass moves along a line and it turns about it, both
/// uniformly. The turn is the shorter one, so it is less than half a turn.
class BodyMotion {
 public:
  /// At rest.
  explicit BodyMotion(const Pose& X_WP) : X_0_(X_WP), center_W_(X_WP.p) {}
  /// @param center_P  centre of mass in the part's frame
  BodyMotion(const Pose& X_0, const Pose& X_1, const Vec3& center_P);

  [[nodiscard]] Pose at(double share) const;
  [[nodiscard]] const Pose& start() const { return X_0_; }
  [[nodiscard]] const Vec3& centerStart_W() const { return center_W_; }
  [[nodiscard]] const Vec3& way_W() const { return way_W_; }    ///< of the centre of mass
  [[nodiscard]] const Vec3& turn_W() const { return turn_W_; }  ///< rotation vector

 private:
  Pose X_0_;
  Vec3 center_W_, way_W_ = Vec3::Zero(), turn_W_ = Vec3::Zero();
};

struct RelativeMotion {
  /// At least the length of the path of any point of one body in the frame of the other: no depth and no gap
  /// changes by more.
  double travel_m = 0;
  /// At least the distance of any point of b, in the frame of a, from the chord of its path.
  double sagitta_m = 0;
};
/// @param box_A, box_B  of the bodies, in their frames
RelativeMotion relativeMotion(const BodyMotion& a, const Box& box_A, const BodyMotion& b, const Box& box_B);

}  // namespace vps::scenes
