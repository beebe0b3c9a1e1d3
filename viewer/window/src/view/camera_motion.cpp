// SPDX-License-Identifier: BSD-3-Clause
#include "view/camera_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vps::viewer {
namespace {

/// Length in the scene of one pixel, at a distance in front of the eye.
double metresPerPixel(const Camera& camera, double depth_m, PictureSize size) {
  return 2 * depth_m * std::tan(0.5 * camera.fov_rad) / std::max(1, size.height);
}

/// The point on the ray at the target's depth.
Vec3 atTargetDepth(const Camera& camera, const PixelPlace& at, PictureSize size) {
  const Ray ray = rayThrough(camera, at, size);
  const Vec3 ahead = (camera.target_W - camera.eye_W).normalized();
  return ray.p_W + ray.d_W * ((camera.target_W - camera.eye_W).norm() / ray.d_W.dot(ahead));
}

}  // namespace

Ray rayThrough(const Camera& camera, const PixelPlace& at, PictureSize size) {
  const int width = std::max(1, size.width), height = std::max(1, size.height);
  const auto [half_x, half_y] = camera.halfView(width, height);
  const Vec3 d_C(camera.shift_x + half_x * (2 * at[0] / width - 1),
                 camera.shift_y - half_y * (2 * at[1] / height - 1), -1);
  const Pose X_WC = camera.pose();
  return {camera.eye_W, (X_WC.R * d_C).normalized()};
}

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

}  // namespace vps::viewer
