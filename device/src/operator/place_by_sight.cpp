// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "operator/strategies.h"

namespace vps::device::inline v0 {

namespace {
constexpr double kGain_per_s = 1.2, kSpeedMost_m_s = 5e-3;
constexpr double kCome_s = 2, kHold_s = 5;  // eight fixations at the target
}  // namespace

void PlaceBySight::start(const Situation& situation, const Feel& feel) noexcept {
  situation_ = situation;
  start_s_ = feel.time_s;
  move_ = {};
  move_.looks = true;
  move_.push_N = situation.push_limit_N;
}

Outcome PlaceBySight::step(const Feel& feel, double) noexcept {
  const double t_s = feel.time_s - start_s_;
  const double gain_per_s =
      kGain_per_s / (1 + std::max(0.0, t_s - kCome_s));  // then an average over what it sees
  move_.speed_m_s = std::clamp(gain_per_s * feel.seen_short_m, -kSpeedMost_m_s, kSpeedMost_m_s);
  if (t_s < kHold_s) return Outcome::GoingOn;
  move_.speed_m_s = 0;
  return Outcome::Done;
}

}  // namespace vps::device::inline v0
