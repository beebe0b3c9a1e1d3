// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "operator/strategies/strategies.h"

namespace vps::device {

namespace {
constexpr double kTurnBack_rad_s =
    1.2;  // assumed: a fifth of a turn a second, as a person feels for a thread
constexpr double kTurnBackCreep_m_s = 10e-3;
constexpr double kTurnBackSettle_s = 0.3;
constexpr double kTurnBackLower_s = 2;
constexpr double kSag_m_s = 0.2e-3;  // a part that goes down no faster slides into place and does not drop
constexpr double kDropLeast_m = 0.06e-3;              // beyond the jerks of a handle with dry friction
constexpr double kDropPerPitch = 1.0 / 16;            // half of what a coarse 6H nut plays along a 6g bolt
constexpr double kSinks_m = 0.01e-3, kSunk_s = 0.15;  // the drop is over
}  // namespace

void TurnBack::start(const Situation& situation, const Feel& feel) noexcept {
  situation_ = situation;
  start_s_ = feel.time_s;
  settled_s_ = 0;
  from_rad_ = feel.spin_rad;
  top_m_ = feel.along_m;
  grips_ = feel.grips;
  has_dropped_ = false;
  move_ = {};
  move_.speed_m_s = kTurnBackCreep_m_s;
  move_.push_N = situation.habits.search_N;
}

Outcome TurnBack::step(const Feel& feel, double dt_s) noexcept {
  const double onward = turnsOn(situation_.screw);
  if (grips_ != feel.grips) {  // the hand has just closed
    grips_ = feel.grips;
    settled_s_ = 0;
    start_s_ = feel.time_s;
  }
  const bool is_lowered =
      feel.resist_N > 0.5 * situation_.habits.search_N || feel.time_s > start_s_ + kTurnBackLower_s;
  if (settled_s_ < kTurnBackSettle_s) {
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

}  // namespace vps::device
