// SPDX-License-Identifier: BSD-3-Clause
// How the mouse moves the part in hand: the cursor's drags as the pose that the device's handle is pulled to.
#pragma once

#include <memory>

#include "view/camera_motion.h"
#include "vps_device/pulled_handle.h"
#include "vps_scenes/run/snapshot.h"

namespace vps::viewer {

enum class HandMotion {
  Across,  ///< parallel to the screen, so that the grabbed point stays under the cursor
  Depth,   ///< down the screen: towards the viewer
  Turn,    ///< about the screen's axes, as orbit() turns the view
  Twist,   ///< about the line of sight
};

/// The handle's axes are the scene's, so that a drag's motion is the handle's.
class VPS_VIEWER_API HandDrag {
 public:
  /// @param scale  scene metres per device metre
  explicit HandDrag(double scale);

  /// What the mouse device reads.
  [[nodiscard]] const std::shared_ptr<device::HandleWish>& wish() const { return wish_; }

  /// @param p_W  the grabbed point of the snapshot's part in hand; without one nothing is grabbed
  void grab(const Vec3& p_W, const scenes::Snapshot& shot);
  void drag(const Camera& camera, const PixelPlace& drag, PictureSize size, HandMotion motion);
  /// By the wheel: towards the viewer.
  void pull(const Camera& camera, double way_m);
  /// The grabbed point along a way, or about a rotation vector, in W.
  void move(const Vec3& way_W);
  void turn(const Vec3& turn_W);
  /// The button is up: the handle goes to the part, so that the spring relaxes and the part stays where it
  /// is.
  void letGo(const scenes::Snapshot& shot);
  [[nodiscard]] bool isGrabbed() const { return is_grabbed_; }

  /// Watches a snapshot: from the first one of each step on it is known how the hand holds the part.
  void watch(const scenes::Snapshot& shot);
  /// The grabbed point of the part where it is now, and where the cursor wants it.
  [[nodiscard]] Vec3 grabbedPoint(const Pose& X_WP) const { return X_WP * p_P_; }
  [[nodiscard]] const Vec3& cursorPoint() const { return cursor_W_; }

 private:
  double scale_;
  std::shared_ptr<device::HandleWish> wish_ = std::make_shared<device::HandleWish>();
  Pose X_DH_;                   ///< the wish
  Pose X_DH_grab_, X_WG_grab_;  ///< wish and proxy where the part was grabbed
  Pose X_PG_;                   ///< how the hand holds the part
  int step_ = -1;               ///< of which X_PG_ is known
  Vec3 p_P_ = Vec3::Zero();     ///< the grabbed point
  Vec3 cursor_W_ = Vec3::Zero();
  bool is_grabbed_ = false;
};

/// The part in hand of a snapshot; null: none.
[[nodiscard]] VPS_VIEWER_API const scenes::BodySnapshot* partInHand(const scenes::Snapshot& shot);

}  // namespace vps::viewer
