// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "operator/strategies/strategies.h"

namespace vps::device {

namespace {
constexpr double kRamp_s = 0.2;          // of the press, up and down
constexpr double kResidualShare = 0.15;  // of the press, kept until release so that the part stays seated
constexpr double kPressHomeCreep_m_s =
    80e-3;  // the reach grows to the press within its ramp; the push is what limits it
constexpr double kPressHomeLook_s = 0.6;
constexpr double kYields = 4;  // errors of sight
}  // namespace

void PressHome::start(const Situation& situation, const Feel& feel) noexcept {
  situation_ = situation;
  start_s_ = feel.time_s;
  has_yielded_ = false;
  move_ = {};
  move_.speed_m_s = kPressHomeCreep_m_s;
  move_.push_N = situation.habits.search_N;
  move_.gives_way = true;
}

Outcome PressHome::step(const Feel& feel, double) noexcept {
  const OperatorHabits& habits = situation_.habits;
  const double t_s = feel.time_s - start_s_, down_s = kRamp_s + habits.press_s;
  const double ramp = t_s < down_s ? minimumJerk(t_s / kRamp_s) : 1 - minimumJerk((t_s - down_s) / kRamp_s);
  move_.push_N = habits.press_N * (kResidualShare + (1 - kResidualShare) * ramp);
  if (feel.seen_short_m < -kYields * habits.see_error_m) {
    has_yielded_ = true;
    return Outcome::Failed;
  }
  if (t_s < down_s + kRamp_s + habits.see_delay_s + kPressHomeLook_s) return Outcome::GoingOn;
  return std::abs(feel.seen_short_m) < situation_.near_m ? Outcome::Done : Outcome::Failed;
}

}  // namespace vps::device
