// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/camera.h"

#include <algorithm>
#include <cmath>

namespace vps::viewer {

Pose Camera::pose() const {
  const Vec3 z = (eye_W - target_W).normalized();
  Vec3 x = up_W.cross(z);
  if (x.norm() < 1e-6) x = z.unitOrthogonal();  // straight down: any horizontal will do, but always the same
  x.normalize();
  Mat3 R;
  R << x, z.cross(x), z;
  return {R, eye_W};
}

std::array<double, 2> Camera::project(const Vec3& p_W, int width, int height) const {
  const Vec3 p_C = pose().inverse() * p_W;
  const double scale = 0.5 * height / (std::tan(0.5 * fov_rad) * -p_C.z());
  return {0.5 * width + scale * p_C.x(), 0.5 * height - scale * p_C.y()};
}

Camera frameScene(const Box& box_W, const Vec3& direction, double fov_rad, double aspect, double margin) {
  Camera camera;
  camera.fov_rad = fov_rad;
  if (box_W.isEmpty()) return camera;
  camera.target_W = box_W.center();
  const Vec3 back = direction.normalized();
  camera.eye_W = camera.target_W + back;
  const Pose X_WC = camera.pose();

  // A corner at (x, y, z) in a camera frame moved to the target is inside the picture where
  // |x| <= (d - z) tan(fov/2) aspect and |y| <= (d - z) tan(fov/2): solve each for the distance d, take the
  // greatest.
  const double tan_y = std::tan(0.5 * fov_rad) * (1 - margin), tan_x = tan_y * aspect;
  double distance_m = 1e-6;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p_W((corner & 1) != 0 ? box_W.max.x() : box_W.min.x(),
                   (corner & 2) != 0 ? box_W.max.y() : box_W.min.y(),
                   (corner & 4) != 0 ? box_W.max.z() : box_W.min.z());
    const Vec3 p_C = X_WC.R.transpose() * (p_W - camera.target_W);
    distance_m =
        std::max({distance_m, p_C.z() + std::abs(p_C.x()) / tan_x, p_C.z() + std::abs(p_C.y()) / tan_y});
  }
  camera.eye_W = camera.target_W + distance_m * back;
  return camera;
}

}  // namespace vps::viewer
