// SPDX-License-Identifier: BSD-3-Clause
// Letting go of a part and taking it again, elsewhere or another one, without a jump of force and without
// energy: a lever between hand and proxy whose ratio goes from 1 to 0 and back.
//
//   hand --[ lever, ratio g ]-- proxy --[ coupling ]-- part
//   force on the hand = g x the coupling's,   the proxy goes g x the hand's way
//
// Power is the same on both sides at every ratio, so nothing is made or lost while it changes, whatever the
// hand does meanwhile and however the spring is stretched. At 0 the proxy stands, and holds the part where it
// is; the hand is free. Fading the force alone would not do: a hand that lifts while a weight fades in would
// lift it for nothing.
#pragma once

#include <algorithm>

#include "vps/pose.h"
#include "vps/wrench.h"
#include "vps_device/export.h"

namespace vps::device {

class VPS_DEVICE_API Clutch {
 public:
  /// Lets go, over fade_s.
  void open() noexcept { is_closing_ = false; }
  /// Takes hold, over fade_s.
  void close() noexcept { is_closing_ = true; }
  /// At once: for what exerts no force yet.
  void shut() noexcept {
    is_closing_ = true;
    ratio_ = 1;
  }
  void drop() noexcept {
    is_closing_ = false;
    ratio_ = 0;
  }

  [[nodiscard]] double ratio() const noexcept { return ratio_; }
  [[nodiscard]] bool isOpen() const noexcept { return ratio_ == 0; }
  [[nodiscard]] bool isClosed() const noexcept { return ratio_ == 1; }

  /// One period further; fade_s > 0.
  void advance(double dt_s, double fade_s) noexcept {
    ratio_ = std::clamp(ratio_ + (is_closing_ ? 1 : -1) * dt_s / fade_s, 0.0, 1.0);
  }

  /// Where the proxy goes from X_W while the hand that holds it there goes on by `step` (turn and way, in W).
  [[nodiscard]] Pose follow(const Pose& X_W, const Twist& step) const noexcept {
    return {Mat3(rotationFromVector(ratio_ * step.w) * X_W.R), Vec3(X_W.p + ratio_ * step.v)};
  }

 private:
  double ratio_ = 1;
  bool is_closing_ = true;
};

}  // namespace vps::device
