// SPDX-License-Identifier: BSD-3-Clause
// The scene on a table before the wearer of a headset.
//
//        y up            The room's frame R has its origin where the head was at first, y up and -z ahead,
//        |               as OpenXR's local space. The scene stands on a table before and below the head,
//        +---- x         its z up, its x to the right, as in the front view.
//       /
//      z to the wearer
#pragma once

#include <array>

#include "vps_viewer/draw/camera.h"

namespace vps::viewer {

/// Of an eye in a headset.
struct HeadsetEye {
  Pose X_RE;  ///< in the room; it looks along its -z
  /// Tangents of the angles from its line of sight to the edges of its picture: left and down are negative.
  double left = -1, right = 1, down = -1, up = 1;
};

/// Where the scene's frame W is in the room, and its size there.
struct TableRoom {
  Pose X_RW;         ///< of the enlarged scene
  double scale = 1;  ///< metres of the room for a metre of the scene

  /// p_W of a point in the room, in metres of the scene.
  [[nodiscard]] Vec3 toScene(const Vec3& p_R) const { return X_RW.R.transpose() * (p_R - X_RW.p) / scale; }
  [[nodiscard]] Vec3 toRoom(const Vec3& p_W) const { return scale * (X_RW.R * p_W) + X_RW.p; }
  /// A frame of the room in the scene.
  [[nodiscard]] Pose toScene(const Pose& X_RF) const {
    return {Mat3(X_RW.R.transpose() * X_RF.R), toScene(X_RF.p)};
  }
};

/// The greatest width and depth of the scene in the room, as in the browser's page, and its greatest height.
/// assumed: within the reach of arms and below the eyes
inline constexpr double kOnTable_m = 0.6, kHighOnTable_m = 0.4;

/// The middle of the box's floor stands 0.6 m before and 0.45 m below the head; assumed: a seated person's
/// table.
[[nodiscard]] VPS_VIEWER_API TableRoom onTable(const Box& box_W);

/// The camera of an eye in the scene, whose picture has exactly the eye's field of view.
[[nodiscard]] VPS_VIEWER_API Camera cameraOf(const TableRoom& room, const HeadsetEye& eye, const Box& box_W);

}  // namespace vps::viewer
