// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "operator/strategies/strategies.h"

namespace vps::device {

namespace {
constexpr double kBackOffSpeed_m_s = 15e-3;
constexpr double kBackOffLongest_s = 4;
constexpr double kBackOffLook_s = 0.6;       // two fixations
constexpr double kBackOffLookLongest_s = 3;  // until the end of a slender part is before its hole
constexpr double kBackOffNear_m = 0.1e-3;
}  // namespace

void BackOff::start(const Situation& situation, const Feel& feel) noexcept {
  situation_ = situation;
  start_s_ = feel.time_s;
  looked_s_ = 0;
  const double from_m = is_whole_ ? std::min(feel.along_m, situation.mouth_m) : feel.along_m;
  goal_m_ = from_m - situation.habits.back_off_m;
  longest_s_ = kBackOffLongest_s;
  if (situation.is_slender)
    longest_s_ += kBackOffLookLongest_s + (feel.along_m - goal_m_) / kBackOffSpeed_m_s;
  move_ = {};
  move_.speed_m_s = -kBackOffSpeed_m_s;
  move_.gives_way = true;
}

Outcome BackOff::step(const Feel& feel, double dt_s) noexcept {
  if (feel.time_s > start_s_ + longest_s_) return Outcome::Done;
  if (looked_s_ == 0 && feel.along_m > goal_m_ + kBackOffNear_m) return Outcome::GoingOn;
  move_.speed_m_s = 0;
  if (!is_whole_) return Outcome::Done;
  move_.gives_way = false;
  move_.looks = true;
  looked_s_ += dt_s;
  if (looked_s_ < kBackOffLook_s) return Outcome::GoingOn;
  const bool is_there = !situation_.is_slender || feel.tip_m.norm() < situation_.habits.see_error_m;
  return is_there || looked_s_ > kBackOffLookLongest_s ? Outcome::Done : Outcome::GoingOn;
}

}  // namespace vps::device
