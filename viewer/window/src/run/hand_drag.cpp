// SPDX-License-Identifier: BSD-3-Clause
#include "run/hand_drag.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "vps_device/pulled_handle.h"

namespace vps::viewer {

HandDrag::HandDrag(double scale) : scale_(scale) {}

void HandDrag::grab(const Vec3& p_W, const scenes::Snapshot& shot) {
  const scenes::BodySnapshot* body = partInHand(shot);
  if (body == nullptr || !shot.has_hand) return;
  p_P_ = body->X_WP.inverse() * p_W;
  X_DH_grab_ = X_DH_;
  X_WG_grab_ = shot.X_W_Proxy;
  cursor_W_ = p_W;
  is_grabbed_ = true;
}

void HandDrag::move(const Vec3& way_W) {
  cursor_W_ += way_W;
  X_DH_.p += way_W / scale_;
  wish_->write(X_DH_);
}

void HandDrag::turn(const Vec3& turn_W) {
  X_DH_ = Pose(Quat(rotationFromVector(turn_W) * X_DH_.R), X_DH_.p);
  wish_->write(X_DH_);
}

void HandDrag::drag(const Camera& camera, const PixelPlace& drag, PictureSize size, HandMotion motion) {
  if (!is_grabbed_) return;
  const Mat3 R_WC = camera.pose().R;
  const double depth_m = std::max(1e-9, -(camera.pose().inverse() * cursor_W_).z());
  const double m_per_px = 2 * depth_m * std::tan(0.5 * camera.fov_rad) / std::max(1, size.height);
  const double rad_per_px = std::numbers::pi / std::max(1, size.height);
  switch (motion) {
    case HandMotion::Across:
      return move(R_WC * Vec3(m_per_px * drag[0], -m_per_px * drag[1], 0));
    case HandMotion::Depth:
      return pull(camera, m_per_px * drag[1]);
    case HandMotion::Turn:
      return turn(R_WC * Vec3(rad_per_px * drag[1], rad_per_px * drag[0], 0));
    case HandMotion::Twist:
      return turn(R_WC * Vec3(0, 0, -rad_per_px * drag[0]));
  }
}

void HandDrag::pull(const Camera& camera, double way_m) {
  // The point moves along the ray through the eye, so that it stays under the cursor.
  move(way_m * (camera.eye_W - cursor_W_).normalized());
}

void HandDrag::letGo(const scenes::Snapshot& shot) {
  is_grabbed_ = false;
  const scenes::BodySnapshot* body = partInHand(shot);
  if (body == nullptr || !shot.has_hand || shot.step != step_) return;
  // The wish follows from the proxy's motion since the grab, since the proxy moves and turns as the handle
  // does.
  const Pose X_WG = body->X_WP * X_PG_;
  X_DH_.p = X_DH_grab_.p + (X_WG.p - X_WG_grab_.p) / scale_;
  X_DH_.R = X_DH_grab_.R;
  turn(rotationVector(X_WG.R * X_WG_grab_.R.transpose()));
}

void HandDrag::watch(const scenes::Snapshot& shot) {
  const scenes::BodySnapshot* body = partInHand(shot);
  if (body == nullptr || !shot.has_hand) {
    is_grabbed_ = false;
    step_ = -1;
    return;
  }
  if (shot.step == step_) return;
  step_ = shot.step;
  X_PG_ = body->X_WP.inverse() * shot.X_W_Proxy;
}

const scenes::BodySnapshot* partInHand(const scenes::Snapshot& shot) {
  for (const scenes::BodySnapshot& body : shot.bodies)
    if (body.role == scenes::BodyRole::InHand) return &body;
  return nullptr;
}

HandMark handMark(const scenes::Snapshot& shot) {
  const double force_N = shot.F_hand_W.f.norm(), torque_Nm = shot.F_hand_W.tau.norm();
  const device::PulledHandleSettings full;
  char words[64];
  std::snprintf(words, sizeof words, "%.1f N  %.2f N m", force_N, torque_Nm);
  return {words, std::max(force_N / full.force_N, torque_Nm / full.torque_Nm)};
}

std::vector<PixelPlace> handMarkPlaces(StereoMode mode, const Vec3& hand_W, const Camera& camera,
                                       PictureSize size) {
  constexpr double kBeside_px = 16, kAbove_px = 40;
  if (mode == StereoMode::Mono) {
    const auto [x, y] = camera.project(hand_W, size.width, size.height);
    return {{x + kBeside_px, y}};
  }
  const double x = kBeside_px, y = size.height - kAbove_px;
  if (mode == StereoMode::SideBySide) return {{x, y}, {x + 0.5 * size.width, y}};
  if (mode == StereoMode::TopBottom) return {{x, y - 0.5 * size.height}, {x, y}};
  return {{x, y}};
}

}  // namespace vps::viewer
