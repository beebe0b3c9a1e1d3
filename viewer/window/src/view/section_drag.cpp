// SPDX-License-Identifier: BSD-3-Clause
#include "view/section_drag.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/box_corners.h"

namespace vps::viewer {

CutPlane sectionFacing(const Camera& camera, const Box& box_W) {
  const Vec3 back = camera.eye_W - camera.target_W;
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(back[k]) > std::abs(back[axis])) axis = k;
  CutPlane cut;
  cut.p_W = box_W.center();
  cut.n_W = Vec3::Unit(axis) * (back[axis] < 0 ? -1 : 1);
  return cut;
}

void dragSection(CutPlane& cut, const Camera& camera, const PixelPlace& drag, PictureSize size,
                 const Box& box_W) {
  const Vec3 n_W = cut.n_W.normalized();
  const Vec3 n_C = camera.pose().R.transpose() * n_W;
  const double depth_m = std::max(1e-9, -(camera.pose().inverse() * cut.p_W).z());
  const double m_per_px = 2 * depth_m * std::tan(0.5 * camera.fov_rad) / std::max(1, size.height);
  // The drag in the plane of the screen, y up, along the normal's picture. A normal that points at the eye
  // has none: then up is away from the eye.
  const double flat = std::hypot(n_C.x(), n_C.y());
  constexpr double kSinTenDegrees = 0.17;
  const double along_px = flat > kSinTenDegrees ? (n_C.x() * drag[0] - n_C.y() * drag[1]) / (flat * flat)
                                                : (n_C.z() > 0 ? drag[1] : -drag[1]);
  double low = 1e300, high = -1e300;
  for (const Vec3& p_W : corners(box_W)) {
    low = std::min(low, n_W.dot(p_W));
    high = std::max(high, n_W.dot(p_W));
  }
  const double offset = n_W.dot(cut.p_W);
  cut.p_W += n_W * (std::clamp(offset + m_per_px * along_px, low, high) - offset);
}

void tiltSection(CutPlane& cut, const Camera& camera, const PixelPlace& drag, PictureSize size) {
  const double rad_per_px = std::numbers::pi / std::max(1, size.height);
  const Mat3 R_WC = camera.pose().R;
  const Vec3 turn_W = R_WC * Vec3(rad_per_px * drag[1], rad_per_px * drag[0], 0);
  cut.n_W = (rotationFromVector(turn_W) * cut.n_W).normalized();
}

}  // namespace vps::viewer
