// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "operator/strategies/strategies.h"

namespace vps::device {

namespace {
constexpr double kTouchCreep_m_s = 10e-3;
constexpr double kTouchLongest_s = 3;
}  // namespace

void Touch::start(const Situation& situation, const Feel& feel) noexcept {
  situation_ = situation;
  start_s_ = feel.time_s;
  progress_.start(feel.along_m, feel.time_s);
  move_ = {};
  move_.speed_m_s = kTouchCreep_m_s;
  move_.push_N = situation.habits.search_N;
  move_.gives_way = true;
}

Outcome Touch::step(const Feel& feel, double) noexcept {
  const double stuck_s = progress_.step(feel.along_m, feel.time_s, situation_.habits.progress_m);
  const bool is_over = stuck_s > situation_.habits.stuck_s || feel.time_s > start_s_ + kTouchLongest_s;
  return is_over ? Outcome::Done : Outcome::GoingOn;
}

}  // namespace vps::device
