// SPDX-License-Identifier: BSD-3-Clause
// Places the scene on a table in front of the wearer of a headset.
//
//        y up            The room's frame R is OpenXR's local space: its origin is the first position of the
//        |               head, y is up, and -z is ahead. The scene is on a table in front of and below
//        +---- x         the head, with its z up and its x to the right, as in the front view.
//       /
//      z to the wearer
#pragma once

#include <array>

#include "vps_viewer/draw/camera.h"

namespace vps::viewer {

/// Pose and field of view of an eye in a headset.
struct HeadsetEye {
  Pose X_RE;  ///< pose in the room; the eye looks along its -z
  /// Tangents of the angles from the line of sight to the edges of the picture; left and down are negative.
  double left = -1, right = 1, down = -1, up = 1;
};

/// Pose and scale of the scene's frame W in the room.
struct TableRoom {
  Pose X_RW;         ///< pose of the scaled scene
  double scale = 1;  ///< metres in the room per metre of the scene

  /// Converts a point of the room to the scene's frame W.
  [[nodiscard]] Vec3 toScene(const Vec3& p_R) const { return X_RW.R.transpose() * (p_R - X_RW.p) / scale; }
  [[nodiscard]] Vec3 toRoom(const Vec3& p_W) const { return scale * (X_RW.R * p_W) + X_RW.p; }
  /// Converts a pose in the room to the scene's frame W.
  [[nodiscard]] Pose toScene(const Pose& X_RF) const {
    return {Mat3(X_RW.R.transpose() * X_RF.R), toScene(X_RF.p)};
  }
};

/// Greatest width and depth of the scene in the room (as on the web page), and its greatest height.
/// assumed: within the reach of arms and below the eyes
inline constexpr double kOnTable_m = 0.6, kHighOnTable_m = 0.4;

/// Places the scene so that the centre of the box's floor is 0.6 m in front of and 0.45 m below the head.
/// assumed: the table of a seated person
[[nodiscard]] VPS_VIEWER_API TableRoom onTable(const Box& box_W);

/// The camera of an eye in the scene, with exactly the eye's field of view.
[[nodiscard]] VPS_VIEWER_API Camera cameraOf(const TableRoom& room, const HeadsetEye& eye, const Box& box_W);

}  // namespace vps::viewer
