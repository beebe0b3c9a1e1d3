// SPDX-License-Identifier: BSD-3-Clause
// Releases and re-grasps a part without a jump of force and without adding energy: a lever between hand and
// proxy whose ratio goes from 1 to 0 and back.
//
//   hand --[ lever, ratio g ]-- proxy --[ coupling ]-- part
//   force on the hand = g x the coupling's,   displacement of the proxy = g x the hand's
//
// Power is equal on both sides at every ratio, so that energy is conserved while the ratio changes, whatever
// the hand's motion and the spring's extension. At 0 the proxy stands still and holds the part; the hand is
// free. Fading only the force would not conserve energy: a hand that rises while a weight fades in would lift
// it without doing the work.
#pragma once

#include <algorithm>

#include "vps/pose.h"
#include "vps/wrench.h"
#include "vps_device/export.h"

namespace vps::device {

class VPS_DEVICE_API Clutch {
 public:
  /// Opens over fade_s.
  void open() noexcept { is_closing_ = false; }
  /// Closes over fade_s.
  void close() noexcept { is_closing_ = true; }
  /// Close and open at once, where the coupling exerts no force.
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
