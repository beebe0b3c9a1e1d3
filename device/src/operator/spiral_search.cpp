// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "operator/strategies.h"

namespace vps::device::inline v0 {

namespace {
constexpr double kSpiralSearchSpeed_m_s = 2.5e-3;  // along the spiral
constexpr double kTurnMost_rad_s = 12;             // near its centre: two turns a second
constexpr double kSpiralSearchCreep_m_s = 10e-3;
constexpr double kSpiralSearchSettle_s = 0.3;
constexpr double kSpiralSearchDropped_m = 0.15e-3;
}  // namespace

void SpiralSearch::start(const Situation& situation, const Feel& feel) noexcept {
  situation_ = situation;
  angle_rad_ = wait_s_ = 0;
  level_m_ = feel.along_m;
  move_ = {};
  move_.speed_m_s = kSpiralSearchCreep_m_s;
  move_.push_N = situation.habits.search_N;
}

Outcome SpiralSearch::step(const Feel& feel, double dt_s) noexcept {
  constexpr double kTurn_rad = 6.283185307179586;
  wait_s_ += dt_s;
  if (feel.resist_N < 0.5 * situation_.habits.search_N && wait_s_ < 2) {  // it is lowered first
    level_m_ = feel.along_m;
    return Outcome::GoingOn;
  }
  if (wait_s_ < kSpiralSearchSettle_s) {
    level_m_ = feel.along_m;
    return Outcome::GoingOn;
  }
  if (feel.along_m > level_m_ + kSpiralSearchDropped_m) return Outcome::Done;
  const double pitch_m = situation_.habits.search_m, radius_m = pitch_m * angle_rad_ / kTurn_rad;
  if (radius_m > situation_.habits.search_limit_m) return Outcome::Failed;
  angle_rad_ += dt_s * std::min(kTurnMost_rad_s, kSpiralSearchSpeed_m_s / std::max(radius_m, 1e-9));
  const Vec3 x = situation_.axis_W.unitOrthogonal(), y = situation_.axis_W.cross(x);
  move_.across_m = radius_m * (std::cos(angle_rad_) * x + std::sin(angle_rad_) * y);
  return Outcome::GoingOn;
}

}  // namespace vps::device::inline v0
