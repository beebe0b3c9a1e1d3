// SPDX-License-Identifier: BSD-3-Clause
// The camera of a picture.
#pragma once

#include <array>

#include "vps/mesh.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// A perspective camera that looks from eye to target. Near and far planes are computed from the drawn scene.
struct VPS_VIEWER_API Camera {
  Vec3 eye_W = Vec3(1, -1, 1);
  Vec3 target_W = Vec3::Zero();
  Vec3 up_W = Vec3::UnitZ();
  double fov_rad = 0.5;  ///< vertical angle of view; 0.5 is a short telephoto lens, which keeps proportions
  /// Off-axis frustum: position of the picture's middle, as tangents to the right of and above the line from
  /// eye to target. The line from eye to target stays perpendicular to the picture; fov_rad is then 2
  /// atan(half the picture's height / distance).
  double shift_x = 0, shift_y = 0;
  double aspect = 0;  ///< width over height of the frustum; 0: as the picture's pixels

  /// Pose of the camera frame C in W: x right, y up, z towards the viewer.
  [[nodiscard]] Pose pose() const;
  /// Tangents of half the horizontal and half the vertical angle of view, in a picture of the given size
  /// [px].
  [[nodiscard]] std::array<double, 2> halfView(int width, int height) const;
  /// Pixel (x right, y down, pixel centres at half integers) of a point in front of the camera.
  [[nodiscard]] std::array<double, 2> project(const Vec3& p_W, int width, int height) const;

  bool operator==(const Camera&) const = default;
};

/// The nearest camera that looks along -direction and shows the whole box.
/// @param direction from the scene to the eye, any length but zero
/// @param fov_rad   vertical angle of view
/// @param aspect    width / height of the picture
/// @param margin    share of half the picture's size that stays free around the box
VPS_VIEWER_API Camera frameScene(const Box& box_W, const Vec3& direction, double fov_rad = 0.5,
                                 double aspect = 4.0 / 3, double margin = 0.12);

}  // namespace vps::viewer
