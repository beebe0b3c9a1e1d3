// SPDX-License-Identifier: BSD-3-Clause
// The part in hand under the mouse: drags of the cursor move the pose that the device's handle is pulled to,
// and a mark in the picture shows the force on the hand.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "view/camera_motion.h"
#include "vps_device/pulled_handle.h"
#include "vps_scenes/run/snapshot.h"
#include "vps_viewer/draw/stereo.h"

namespace vps::viewer {

enum class HandMotion {
  Across,  ///< moves the part parallel to the screen, so that the grabbed point stays under the cursor
  Depth,   ///< moves the part along the line of sight; a drag down the screen moves towards the viewer
  Turn,    ///< turns the part about the screen's axes, as orbit() turns the view
  Twist,   ///< turns the part about the line of sight
};

/// Converts drags of the cursor to the pose that the mouse device's handle is pulled to. The handle's axes
/// are parallel to the scene's.
class VPS_VIEWER_API HandDrag {
 public:
  /// @param scale  scene metres per device metre
  explicit HandDrag(double scale);

  /// The pose that the mouse device reads.
  [[nodiscard]] const std::shared_ptr<device::HandleWish>& wish() const { return wish_; }

  /// Grabs the snapshot's part in hand; does nothing if there is none.
  /// @param p_W  grabbed point of the part
  void grab(const Vec3& p_W, const scenes::Snapshot& shot);
  void drag(const Camera& camera, const PixelPlace& drag, PictureSize size, HandMotion motion);
  /// Moves the grabbed point towards the viewer (mouse wheel).
  void pull(const Camera& camera, double way_m);
  /// Moves the grabbed point by a translation in W.
  void move(const Vec3& way_W);
  /// Turns the part about the grabbed point by a rotation vector in W.
  void turn(const Vec3& turn_W);
  /// Releases the part: the wish moves to the part's pose, so that the spring relaxes and the part stays in
  /// place.
  void letGo(const scenes::Snapshot& shot);
  [[nodiscard]] bool isGrabbed() const { return is_grabbed_; }

  /// Updates the hand's pose on the part, from the first snapshot of each step. Call it with every snapshot.
  void watch(const scenes::Snapshot& shot);
  /// The grabbed point at the part's present pose.
  [[nodiscard]] Vec3 grabbedPoint(const Pose& X_WP) const { return X_WP * p_P_; }
  /// The place to which the cursor pulls the grabbed point.
  [[nodiscard]] const Vec3& cursorPoint() const { return cursor_W_; }

 private:
  double scale_;
  std::shared_ptr<device::HandleWish> wish_ = std::make_shared<device::HandleWish>();
  Pose X_DH_;                   ///< pose to which the handle is pulled
  Pose X_DH_grab_, X_WG_grab_;  ///< X_DH_ and the proxy's pose when the part was grabbed
  Pose X_PG_;                   ///< pose of the hand's proxy on the part
  int step_ = -1;               ///< step whose X_PG_ is known
  Vec3 p_P_ = Vec3::Zero();     ///< the grabbed point
  Vec3 cursor_W_ = Vec3::Zero();
  bool is_grabbed_ = false;
};

/// The part in hand of a snapshot; null if there is none.
[[nodiscard]] VPS_VIEWER_API const scenes::BodySnapshot* partInHand(const scenes::Snapshot& shot);

/// The force on the hand as a number and a colour, for people whose device has no force feedback.
struct HandMark {
  std::string words;  ///< "2.5 N  0.10 N m"
  double share = 0;   ///< position on the colour scale, whose end is the mouse's greatest force or torque
};
[[nodiscard]] VPS_VIEWER_API HandMark handMark(const scenes::Snapshot& shot);

/// Left ends of the mark's text in the picture. Without stereo the mark is next to the hand. In stereo the
/// mark is at the left border, which both eyes see at the depth of the screen; if each eye has its own half
/// of the picture, there is a mark in each half.
[[nodiscard]] VPS_VIEWER_API std::vector<PixelPlace> handMarkPlaces(StereoMode mode, const Vec3& hand_W,
                                                                    const Camera& camera, PictureSize size);

}  // namespace vps::viewer
