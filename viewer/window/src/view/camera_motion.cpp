// SPDX-License-Identifier: BSD-3-Clause
#include "view/camera_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/scene_meshes.h"

namespace vps::viewer {
namespace {

/// Length in the scene of one pixel, at a distance in front of the eye.
double metresPerPixel(const Camera& camera, double depth_m, PictureSize size) {
  return 2 * depth_m * std::tan(0.5 * camera.fov_rad) / std::max(1, size.height);
}

/// The point on the pixel's ray at the target's depth.
Vec3 atTargetDepth(const Camera& camera, const PixelPlace& at, PictureSize size) {
  const Ray ray = rayThrough(camera, at, size);
  const Vec3 ahead = (camera.target_W - camera.eye_W).normalized();
  return ray.p_W + ray.d_W * ((camera.target_W - camera.eye_W).norm() / ray.d_W.dot(ahead));
}

}  // namespace

void orbit(Camera& camera, const PixelPlace& drag, PictureSize size) {
  constexpr double kPole_rad = 0.02;  // least angle between the view and the up direction
  const double rad_per_px = std::numbers::pi / std::max(1, size.height);
  const Vec3 up = camera.up_W.normalized();
  Vec3 back = camera.eye_W - camera.target_W;
  const double distance_m = back.norm();
  back /= distance_m;
  const Vec3 right = camera.pose().R.col(0);
  const double from_pole = std::acos(std::clamp(back.dot(up), -1.0, 1.0));
  const double tilted = std::clamp(from_pole - rad_per_px * drag[1], kPole_rad, std::numbers::pi - kPole_rad);
  // A turn about `right` by a positive angle takes `up` towards `back`, that is, away from the pole.
  back = rotationFromVector(right * (tilted - from_pole)) * back;
  back = rotationFromVector(up * (-rad_per_px * drag[0])) * back;
  camera.eye_W = camera.target_W + distance_m * back;
}

void pan(Camera& camera, const PixelPlace& drag, double depth_m, PictureSize size) {
  const double scale = metresPerPixel(camera, depth_m, size);
  const Vec3 move = camera.pose().R * Vec3(-scale * drag[0], scale * drag[1], 0);
  camera.eye_W += move;
  camera.target_W += move;
}

void pan(Camera& camera, const PixelPlace& drag, PictureSize size) {
  pan(camera, drag, (camera.target_W - camera.eye_W).norm(), size);
}

void zoom(Camera& camera, double factor, const PixelPlace& at, PictureSize size, double least_m,
          double most_m) {
  if (!(factor > 0) || !std::isfinite(factor)) return;
  const Vec3 held_W = atTargetDepth(camera, at, size);
  const Vec3 back = camera.eye_W - camera.target_W;
  const double distance_m = std::clamp(back.norm() / factor, least_m, most_m);
  camera.eye_W = camera.target_W + back.normalized() * distance_m;
  const Vec3 shift = held_W - atTargetDepth(camera, at, size);
  camera.eye_W += shift;
  camera.target_W += shift;
}

const std::vector<StandardView>& standardViews() {
  static const std::vector<StandardView> views = {
      {"iso", Vec3(1, -1.4, 0.9), Vec3::UnitZ()}, {"front", Vec3(0, -1, 0), Vec3::UnitZ()},
      {"back", Vec3(0, 1, 0), Vec3::UnitZ()},     {"left", Vec3(-1, 0, 0), Vec3::UnitZ()},
      {"right", Vec3(1, 0, 0), Vec3::UnitZ()},    {"top", Vec3(0, 0, 1), Vec3::UnitY()},
      {"bottom", Vec3(0, 0, -1), Vec3::UnitY()}};
  return views;
}

Camera cameraFor(const StandardView& view, const Box& box_W, PictureSize size) {
  Camera camera = frameScene(box_W, view.direction_W, Camera{}.fov_rad,
                             double(std::max(1, size.width)) / std::max(1, size.height));
  camera.up_W = view.up_W;
  return camera;
}

Camera fitted(const Camera& camera, const Box& box_W, PictureSize size) {
  Camera near = frameScene(box_W, camera.eye_W - camera.target_W, camera.fov_rad,
                           double(std::max(1, size.width)) / std::max(1, size.height));
  near.up_W = camera.up_W;
  return near;
}

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
  // The drag is projected onto the picture of the normal. A normal that points at the eye has no direction in
  // the picture; then a drag up moves the plane away from the eye.
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
