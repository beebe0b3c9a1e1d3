// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "operator/strategies/strategies.h"

namespace vps::device {

namespace {
constexpr double kScrewTurn_rad = 6.283185307179586;
constexpr double kScrewOn_rad_s = 1.2;    // assumed, as TurnBack
constexpr double kScrewNear_rad_s = 0.6;  // near the target, so that sight can follow
constexpr double kScrewNear_m = 0.5e-3;
constexpr double kScrewOnCreep_m_s = 10e-3;
constexpr double kScrewSettle_s = 0.3;
constexpr double kScrewLook_s = 0.6;  // average of what is seen of the height: two fixations
constexpr double kCaughtTurns = 1;    // it follows the thread by then
constexpr double kCheckTurns = 0.5;
constexpr double kStall_rad = 0.01, kStall_s = 0.5;
constexpr double kJamShare = 0.6;  // of the torque that the hand has
}  // namespace

void ScrewOn::start(const Situation& situation, const Feel& feel) noexcept {
  situation_ = situation;
  start_s_ = feel.time_s;
  from_rad_ = mark_rad_ = feel.spin_rad;
  mark_m_ = along_m_ = feel.along_m;
  short_m_ = feel.seen_short_m;
  lean_rad_ = feel.lean_rad;
  turned_rad_ = 0;
  grips_ = feel.grips;
  has_caught_ = false;
  turning_.start(0, feel.time_s);
  move_ = {};
  move_.speed_m_s = kScrewOnCreep_m_s;
  move_.push_N = situation.habits.search_N;
  move_.gives_way = true;
}

// By the way along the axis since the last mark. A first turn is needed until the play is taken up.
bool ScrewOn::followsThread(const Feel& feel) noexcept {
  const double turns = turnsOn(situation_.screw) * (feel.spin_rad - mark_rad_) / kScrewTurn_rad;
  if (turns < (has_caught_ ? kCheckTurns : kCaughtTurns)) return true;
  const double wanted_m = turns * std::abs(situation_.screw.pitch_m);
  const bool follows = std::abs(feel.along_m - mark_m_ - wanted_m) < ScrewTask::kOffPitch * wanted_m;
  has_caught_ = true;
  mark_rad_ = feel.spin_rad;
  mark_m_ = feel.along_m;
  return follows;
}

Outcome ScrewOn::step(const Feel& feel, double dt_s) noexcept {
  const OperatorHabits& habits = situation_.habits;
  const double onward = turnsOn(situation_.screw);
  if (grips_ != feel.grips) {  // the hand has just closed
    grips_ = feel.grips;
    start_s_ = feel.time_s;
  }
  turned_rad_ = onward * (feel.spin_rad - from_rad_);
  // What it sees is late and noisy, and what it feels of its own motion is neither.
  short_m_ += std::min(1.0, dt_s / kScrewLook_s) * (feel.seen_short_m - short_m_) - (feel.along_m - along_m_);
  along_m_ = feel.along_m;
  const bool is_settled = feel.time_s > start_s_ + kScrewSettle_s;
  const bool is_near = short_m_ < kScrewNear_m;
  move_.spin_rad_s = is_settled ? onward * (is_near ? kScrewNear_rad_s : kScrewOn_rad_s) : 0;
  if (!is_settled) {
    turning_.start(turned_rad_, feel.time_s);
    return Outcome::GoingOn;
  }
  const double torque_Nm = -onward * feel.twist_Nm;
  const bool is_tight = situation_.screw.torque_Nm > 0 && torque_Nm >= situation_.screw.torque_Nm;
  const bool is_there = situation_.screw.torque_Nm <= 0 && short_m_ <= 0;
  if (is_tight || is_there) {
    move_.spin_rad_s = 0;
    return Outcome::Done;
  }
  const bool is_stuck = turning_.step(turned_rad_, feel.time_s, kStall_rad) > kStall_s &&
                        torque_Nm > kJamShare * habits.torque_limit_Nm;
  return is_stuck || (feel.lean_rad - lean_rad_).norm() > ScrewTask::kCrossedLean_rad || !followsThread(feel)
             ? Outcome::Failed
             : Outcome::GoingOn;
}

}  // namespace vps::device
