// SPDX-License-Identifier: BSD-3-Clause
#include "view/table_room.h"

#include <algorithm>
#include <cmath>

namespace vps::viewer {
namespace {

const Vec3 kTable_R(0, -0.45, -0.6);

}  // namespace

TableRoom onTable(const Box& box_W) {
  TableRoom room;
  room.X_RW.R << 1, 0, 0,  // the scene's x to the right, its z up, its y away from the wearer
      0, 0, 1,             //
      0, -1, 0;
  if (box_W.isEmpty()) return {Pose(room.X_RW.R, kTable_R), 1};
  const Vec3 size_m = box_W.size().cwiseMax(1e-9);
  room.scale = std::min(kOnTable_m / std::max(size_m.x(), size_m.y()), kHighOnTable_m / size_m.z());
  const Vec3 middle = box_W.center();
  const Vec3 foot_W(middle.x(), middle.y(), box_W.min.z());
  room.X_RW.p = kTable_R - room.scale * (room.X_RW.R * foot_W);
  return room;
}

Camera cameraOf(const TableRoom& room, const HeadsetEye& eye, const Box& box_W) {
  const Pose X_WE = room.toScene(eye.X_RE);
  const double height = std::max(1e-6, eye.up - eye.down), width = std::max(1e-6, eye.right - eye.left);
  Camera camera;
  camera.eye_W = X_WE.p;
  // The distance of the target does not change the view, only the scale of shading effects.
  const double distance_m = std::max(1e-6, (box_W.center() - X_WE.p).norm());
  camera.target_W = X_WE.p - distance_m * X_WE.R.col(2);
  camera.up_W = X_WE.R.col(1);
  camera.fov_rad = 2 * std::atan(0.5 * height);
  camera.shift_x = 0.5 * (eye.left + eye.right);
  camera.shift_y = 0.5 * (eye.down + eye.up);
  camera.aspect = width / height;
  return camera;
}

}  // namespace vps::viewer
