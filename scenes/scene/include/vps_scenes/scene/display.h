// SPDX-License-Identifier: BSD-3-Clause
// Screens and viewers in a room: the corners of each screen, and the pose of each viewer's head.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vps/pose.h"
#include "vps_scenes/export.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Recorded poses of a head in the room's frame S, in order of time.
struct VPS_SCENES_API HeadTrack {
  std::vector<double> time_s;
  std::vector<Pose> X_SE;

  /// The pose at a time, interpolated between two recorded poses (straight line, shortest rotation); before
  /// the first and after the last recorded time, the nearest pose. The track must not be empty.
  [[nodiscard]] Pose at(double t_s) const;
};

/// Reads rows of time [s], x, y, z [m] and a quaternion x, y, z, w. Throws LoadError with the line of the
/// mistake, also for times that do not increase, and for a quaternion that is no rotation.
VPS_SCENES_API HeadTrack loadHeadTrack(const std::string& file);

/// A flat screen in the room's frame S [m].
struct DisplayScreen {
  std::string name;
  Vec3 lower_left_S = Vec3::Zero(), lower_right_S = Vec3::Zero(), upper_left_S = Vec3::Zero();
  int width = 1920, height = 1080;  ///< pixels

  /// Unit vectors to the right, up, and towards the side from which the screen is seen.
  [[nodiscard]] Mat3 axes() const;
};

/// A head in the room. The eyes are on a line through the head's centre, along x; the head looks along -z.
/// The head's pose is constant, recorded, or received from a topic of the network (tracked_heads.h).
struct DisplayViewer {
  std::string name;
  Pose X_SE;               ///< current pose
  bool is_placed = false;  ///< the file gives the pose of the head, or the first pose of its record
  HeadTrack track;         ///< recorded poses; empty: none
  std::string topic;       ///< topic of ROS 2; empty: none
  int ros_domain = 0;
  std::string network = "lo";     ///< network interface
  double eye_distance_m = 0.063;  ///< mean of adults: Dodgson 2004
  /// Position of an eye; side -1: left, 1: right, 0: the centre of the head.
  [[nodiscard]] Vec3 eye_S(int side) const { return X_SE * Vec3(0.5 * side * eye_distance_m, 0, 0); }
};

/// Whether an eye of the viewer is behind the screen, or within 1 mm of its plane.
[[nodiscard]] VPS_SCENES_API bool isBehind(const DisplayViewer& viewer, const DisplayScreen& screen);

struct Display {
  std::string file;
  std::vector<DisplayScreen> screens;
  std::vector<DisplayViewer> viewers;
  Pose X_SW;         ///< pose of the scene in the room
  double scale = 1;  ///< metres in the room per metre of the scene
  /// Pose of the device in the room, from `vps calibrate`; empty: the pose is unknown.
  std::optional<Pose> X_SD;

  /// Sets scale and placement of a scene's `[device]` so that a part in hand is seen at the hand. Without
  /// X_SD, the function changes nothing.
  VPS_SCENES_API void placeDevice(DeviceSettings& device) const;
  [[nodiscard]] Vec3 toScene(const Vec3& p_S) const { return X_SW.inverse() * p_S / scale; }
};

/// Reads a display file (TOML, viewer/draw/STEREO.md). Throws LoadError with file, line, key and remedy; also
/// for corners that do not form a rectangle, and for a screen that a viewer has behind the head or sees from
/// behind, at any time of a record.
VPS_SCENES_API Display loadDisplay(const std::string& file);

}  // namespace vps::scenes
