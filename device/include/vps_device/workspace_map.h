// SPDX-License-Identifier: BSD-3-Clause
// How device space maps to scene space, and how the hand holds a part.
#pragma once

#include "vps/pose.h"
#include "vps/wrench.h"
#include "vps_device/export.h"

namespace vps::device {

/// Placement of the device's space in the scene: p_W = X_WD (scale p_D). Forces on the hand are force_scale
/// times the scene's. Powers then differ by scale / force_scale; energy is accounted at the hand.
struct VPS_DEVICE_API WorkspaceMap {
  Pose X_WD;
  double scale = 1;        ///< scene metres per device metre, > 0
  double force_scale = 1;  ///< device newtons per scene newton, > 0

  [[nodiscard]] Pose toScene(const Pose& X_DH) const noexcept;
  [[nodiscard]] Pose toDevice(const Pose& X_WH) const noexcept;
  [[nodiscard]] Twist toScene(const Twist& V_D) const noexcept;
  [[nodiscard]] Twist toDevice(const Twist& V_W) const noexcept;
  [[nodiscard]] Wrench toScene(const Wrench& F_D) const noexcept;
  [[nodiscard]] Wrench toDevice(const Wrench& F_W) const noexcept;
};

/// How the hand holds the part. The grasp frame G moves with the handle by an offset that is fixed when
/// grasping, so that grasping at any place and attitude gives no force. Rotating the handle rotates G about
/// its own origin:
///   p_WG = p_WH + offset_W,   R_WG = R_WH R_HG,   hence equal twists, and wrenches pass unchanged.
struct VPS_DEVICE_API Grasp {
  Vec3 offset_W = Vec3::Zero();
  Mat3 R_HG = Mat3::Identity();

  static Grasp between(const Pose& X_WH, const Pose& X_WG) noexcept;
  [[nodiscard]] Pose toGrasp(const Pose& X_WH) const noexcept;
  [[nodiscard]] Pose toHandle(const Pose& X_WG) const noexcept;
};

}  // namespace vps::device
