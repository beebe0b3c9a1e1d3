// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/draw/camera.h"

#include <algorithm>
#include <cmath>

#include "mesh/scene_meshes.h"

namespace vps::viewer {

Pose Camera::pose() const {
  const Vec3 z = (eye_W - target_W).normalized();
  Vec3 x = up_W.cross(z);
  if (x.norm() < 1e-6)
    x = z.unitOrthogonal();  // the view is straight down or up: any fixed horizontal axis is suitable
  x.normalize();
  Mat3 R;
  R << x, z.cross(x), z;
  return {R, eye_W};
}

std::array<double, 2> Camera::project(const Vec3& p_W, int width, int height) const {
  const Vec3 p_C = pose().inverse() * p_W;
  const auto [half_x, half_y] = halfView(width, height);
  const double x = (p_C.x() / -p_C.z() - shift_x) / half_x, y = (p_C.y() / -p_C.z() - shift_y) / half_y;
  return {0.5 * width * (1 + x), 0.5 * height * (1 - y)};
}

std::array<double, 2> Camera::halfView(int width, int height) const {
  const double half_y = std::tan(0.5 * fov_rad);
  return {half_y * (aspect > 0 ? aspect : static_cast<double>(width) / height), half_y};
}

Camera frameScene(const Box& box_W, const Vec3& direction, double fov_rad, double aspect, double margin) {
  Camera camera;
  camera.fov_rad = fov_rad;
  if (box_W.isEmpty()) return camera;
  camera.target_W = box_W.center();
  const Vec3 back = direction.normalized();
  camera.eye_W = camera.target_W + back;
  const Pose X_WC = camera.pose();

  // Let (x, y, z) be a corner of the box relative to the target, in the camera frame. If the eye is at
  // distance d, the corner is inside the picture if |x| <= (d - z) tan(fov/2) aspect and |y| <= (d - z)
  // tan(fov/2). Each corner gives a least d; the camera takes the greatest of these distances.
  const double tan_y = std::tan(0.5 * fov_rad) * (1 - margin), tan_x = tan_y * aspect;
  double distance_m = 1e-6;
  for (const Vec3& p_W : corners(box_W)) {
    const Vec3 p_C = X_WC.R.transpose() * (p_W - camera.target_W);
    distance_m =
        std::max({distance_m, p_C.z() + std::abs(p_C.x()) / tan_x, p_C.z() + std::abs(p_C.y()) / tan_y});
  }
  camera.eye_W = camera.target_W + distance_m * back;
  return camera;
}

}  // namespace vps::viewer
