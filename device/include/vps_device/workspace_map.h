// SPDX-License-Identifier: BSD-3-Clause
// From the handle to the part: how device space maps to scene space, how the hand holds the part, and the
// clutch between them.
#pragma once

#include <algorithm>

#include "vps/pose.h"
#include "vps/wrench.h"

namespace vps::device {

/// Placement of the device's space in the scene: p_W = X_WD (scale p_D). Forces on the hand are force_scale
/// times the scene's. Powers then differ by scale / force_scale; energy is accounted at the hand.
struct WorkspaceMap {
  Pose X_WD;
  double scale = 1;        ///< scene metres per device metre, > 0
  double force_scale = 1;  ///< device newtons per scene newton, > 0

  [[nodiscard]] Pose toScene(const Pose& X_DH) const noexcept {
    return {Mat3(X_WD.R * X_DH.R), X_WD * Vec3(scale * X_DH.p)};
  }
  [[nodiscard]] Pose toDevice(const Pose& X_WH) const noexcept {
    const Mat3 R_DW = X_WD.R.transpose();
    return {Mat3(R_DW * X_WH.R), Vec3(R_DW * (X_WH.p - X_WD.p) / scale)};
  }
  [[nodiscard]] Twist toScene(const Twist& V_D) const noexcept {
    return {X_WD.R * V_D.w, scale * (X_WD.R * V_D.v)};
  }
  [[nodiscard]] Twist toDevice(const Twist& V_W) const noexcept {
    return {X_WD.R.transpose() * V_W.w, X_WD.R.transpose() * V_W.v / scale};
  }
  [[nodiscard]] Wrench toScene(const Wrench& F_D) const noexcept {
    return rotated(X_WD.R, F_D) * (1 / force_scale);
  }
  [[nodiscard]] Wrench toDevice(const Wrench& F_W) const noexcept {
    return rotated(X_WD.R.transpose(), F_W) * force_scale;
  }
};

/// How the hand holds the part. The grasp frame G moves with the handle by an offset that is fixed when
/// grasping, so that grasping at any place and attitude gives no force. Rotating the handle rotates G about
/// its own origin:
///   p_WG = p_WH + offset_W,   R_WG = R_WH R_HG,   hence twists are equal, and wrenches pass unchanged.
struct Grasp {
  Vec3 offset_W = Vec3::Zero();
  Mat3 R_HG = Mat3::Identity();

  static Grasp between(const Pose& X_WH, const Pose& X_WG) noexcept {
    return {X_WG.p - X_WH.p, X_WH.R.transpose() * X_WG.R};
  }
  [[nodiscard]] Pose toGrasp(const Pose& X_WH) const noexcept {
    return {Mat3(X_WH.R * R_HG), Vec3(X_WH.p + offset_W)};
  }
  [[nodiscard]] Pose toHandle(const Pose& X_WG) const noexcept {
    return {Mat3(X_WG.R * R_HG.transpose()), Vec3(X_WG.p - offset_W)};
  }
};

/// Releases and re-grasps a part without a jump of force and without adding energy: a lever between hand and
/// proxy whose ratio goes from 1 to 0 and back.
///
///   hand --[ lever, ratio g ]-- proxy --[ coupling ]-- part
///   force on the hand = g x the coupling's,   displacement of the proxy = g x the hand's
///
/// Power is equal on both sides at every ratio, so that energy is conserved while the ratio changes, whatever
/// the hand's motion and the spring's extension. At ratio 0 the proxy stands still and holds the part; the
/// hand is free. Fading only the force would not conserve energy: a hand that rises while a weight fades in
/// would lift it without doing the work.
class Clutch {
 public:
  /// Opens the clutch over fade_s.
  void open() noexcept { is_closing_ = false; }
  /// Closes the clutch over fade_s.
  void close() noexcept { is_closing_ = true; }
  /// Closes or opens the clutch at once. Only allowed while the coupling exerts no force.
  void closeAtOnce() noexcept {
    is_closing_ = true;
    ratio_ = 1;
  }
  void openAtOnce() noexcept {
    is_closing_ = false;
    ratio_ = 0;
  }

  [[nodiscard]] double ratio() const noexcept { return ratio_; }
  [[nodiscard]] bool isOpen() const noexcept { return ratio_ == 0; }
  [[nodiscard]] bool isClosed() const noexcept { return ratio_ == 1; }

  /// Advances by one period; fade_s > 0.
  void advance(double dt_s, double fade_s) noexcept {
    ratio_ = std::clamp(ratio_ + (is_closing_ ? 1 : -1) * dt_s / fade_s, 0.0, 1.0);
  }

  /// The proxy, now at X_W, after the hand moves by `step` (rotation and translation, in W).
  [[nodiscard]] Pose follow(const Pose& X_W, const Twist& step) const noexcept {
    return {Mat3(rotationFromVector(ratio_ * step.w) * X_W.R), Vec3(X_W.p + ratio_ * step.v)};
  }

 private:
  double ratio_ = 1;
  bool is_closing_ = true;
};

}  // namespace vps::device
