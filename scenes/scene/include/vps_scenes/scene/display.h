// SPDX-License-Identifier: BSD-3-Clause
// Where pictures are shown and who looks at them: screens by their corners, viewers by their heads.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vps/pose.h"
#include "vps_scenes/export.h"
#include "vps_scenes/scene/head_track.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// A flat screen in the room's frame S [m].
struct DisplayScreen {
  std::string name;
  Vec3 lower_left_S = Vec3::Zero(), lower_right_S = Vec3::Zero(), upper_left_S = Vec3::Zero();
  int width = 1920, height = 1080;  ///< pixels

  /// Unit vectors to the right, up, and to the side from which it is seen.
  [[nodiscard]] Mat3 axes() const;
};

/// A head in the room. Its eyes are on a line through its middle, along x; it looks along -z. Where it is
/// comes from a stream: constant, recorded, or a topic of the network (tracked_heads.h).
struct DisplayViewer {
  std::string name;
  Pose X_SE;               ///< now
  bool is_placed = false;  ///< the file says where the head is, or was at first
  HeadTrack track;         ///< recorded; empty: not
  std::string topic;       ///< of ROS 2; empty: none
  int ros_domain = 0;
  std::string network = "lo";     ///< interface
  double eye_distance_m = 0.063;  ///< mean of adults: Dodgson 2004
  /// Of one eye: -1 left, 1 right, 0 the middle of the head.
  [[nodiscard]] Vec3 eye_S(int side) const { return X_SE * Vec3(0.5 * side * eye_distance_m, 0, 0); }
};

/// Whether an eye of the viewer is behind the screen, or as near as 1 mm.
[[nodiscard]] VPS_SCENES_API bool isBehind(const DisplayViewer& viewer, const DisplayScreen& screen);

struct Display {
  std::string file;
  std::vector<DisplayScreen> screens;
  std::vector<DisplayViewer> viewers;
  Pose X_SW;         ///< where the scene stands in the room
  double scale = 1;  ///< metres in the room for a metre of the scene
  /// Where the device stands in the room, by `vps calibrate`; none: it is not known.
  std::optional<Pose> X_SD;

  /// What a scene's `[device]` has to say, so that a part in hand is seen where the hand is. Without X_SD
  /// nothing changes.
  VPS_SCENES_API void placeDevice(DeviceSettings& device) const;
  [[nodiscard]] Vec3 toScene(const Vec3& p_S) const { return X_SW.inverse() * p_S / scale; }
};

/// Reads a display file (TOML, viewer/README.md). Throws LoadError with file, line, key and remedy: also for
/// corners that are no rectangle, and for a screen behind a viewer's head or seen from behind, at any time of
/// a recorded head.
VPS_SCENES_API Display loadDisplay(const std::string& file);

}  // namespace vps::scenes
