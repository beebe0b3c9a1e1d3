// SPDX-License-Identifier: BSD-3-Clause
// Tells impacts from slides, as figure 9 of the paper does.
#pragma once

#include "vps/pose.h"

namespace vps {

/// Splits a run into contact episodes. Touching again within kBridge_s belongs to the same episode: a part
/// that chatters on a surface has hit it once. An episode in which the part slips more than kSlip_m while it
/// touches is a slide; any other is an impact. Thresholds are assumed: 20 ms is below what a hand feels as
/// two events (about 30 ms between taps), and 1 mm of travel is well above what a bounce covers.
class ContactEvents {
 public:
  static constexpr double kBridge_s = 0.02;
  static constexpr double kSlip_m = 1e-3;

  /// One physics step: is the part touching, and how fast its grasp point moves.
  void add(double time_s, double dt_s, bool is_touching, double speed_m_s) {
    if (is_touching) {
      if (!is_open_) {
        is_open_ = true;
        slip_m_ = 0;
      }
      last_touch_s_ = time_s;
      slip_m_ += speed_m_s * dt_s;
    } else if (is_open_ && time_s - last_touch_s_ > kBridge_s) {
      close();
    }
  }
  /// Ends an episode that is still open. Call once at the end.
  void close() {
    if (!is_open_) return;
    is_open_ = false;
    (slip_m_ > kSlip_m ? slides_ : impacts_)++;
  }
  [[nodiscard]] int impacts() const { return impacts_; }
  [[nodiscard]] int slides() const { return slides_; }

 private:
  bool is_open_ = false;
  double last_touch_s_ = 0, slip_m_ = 0;
  int impacts_ = 0, slides_ = 0;
};

}  // namespace vps
