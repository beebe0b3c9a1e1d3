// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "operator/strategies/strategy.h"

namespace vps::device {
namespace {

constexpr double kTurnBack_rad_s =
    1.2;                             // assumed: a fifth of a turn per second, as a person feels for a thread
constexpr double kSag_m_s = 0.2e-3;  // a part that sinks no faster slides into place and does not drop
// Smallest sink that counts as a drop, more than the jerks of a handle with dry friction.
constexpr double kDropLeast_m = 0.06e-3;
constexpr double kDropPerPitch = 1.0 / 16;            // half the axial play of a coarse 6H nut on a 6g bolt
constexpr double kSinks_m = 0.01e-3, kSunk_s = 0.15;  // the drop ends when the part sinks less in kSunk_s

/// Turns against the thread, pressed lightly on the mouth of the other thread, until the part drops: the ends
/// of both threads have passed each other. Failed: the part did not drop.
class TurnBack final : public Strategy {
 public:
  Outcome step(const Feel& feel, double dt_s) noexcept override {
    const double onward = turnsOn(situation_.screw);
    if (grips_ != feel.grips) {  // the hand has just closed again
      grips_ = feel.grips;
      settled_s_ = 0;
      start_s_ = feel.time_s;
    }
    const bool is_lowered =
        feel.resist_N > 0.5 * situation_.habits.search_N || feel.time_s > start_s_ + kLower_s;
    if (settled_s_ < kSettle_s) {
      settled_s_ = is_lowered ? settled_s_ + dt_s : 0;
      top_m_ = feel.along_m;
      move_.spin_rad_s = 0;
      return Outcome::GoingOn;
    }
    move_.spin_rad_s = -onward * kTurnBack_rad_s;
    const double drop_m = std::max(kDropLeast_m, kDropPerPitch * std::abs(situation_.screw.pitch_m));
    top_m_ = std::min(feel.along_m, top_m_ + kSag_m_s * dt_s);
    if (!has_dropped_ && feel.along_m > top_m_ + drop_m) {
      has_dropped_ = true;
      sinking_.start(feel.along_m, feel.time_s);
    }
    if (has_dropped_ && sinking_.step(feel.along_m, feel.time_s, kSinks_m) > kSunk_s) return Outcome::Done;
    const double turned_rad = onward * (from_rad_ - feel.spin_rad);
    return turned_rad > situation_.back_rad ? Outcome::Failed : Outcome::GoingOn;
  }

 private:
  void begin(const Feel& feel) noexcept override {
    settled_s_ = 0;
    from_rad_ = feel.spin_rad;
    top_m_ = feel.along_m;
    grips_ = feel.grips;
    has_dropped_ = false;
    pressLightly();
  }

  double settled_s_ = 0, from_rad_ = 0, top_m_ = 0;
  int grips_ = 0;
  bool has_dropped_ = false;
  Progress sinking_;
};

}  // namespace

std::unique_ptr<Strategy> makeTurnBack() {
  return std::make_unique<TurnBack>();
}

}  // namespace vps::device
