// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "operator/strategies/strategies.h"

namespace vps::device {

namespace {
constexpr double kSpeed_rad_s = 0.12;  // slow enough that the part drops within its clearance
constexpr double kStep_rad = 0.035;    // by which each sweep goes farther than the last to that side
constexpr double kTurnSearchCreep_m_s = 10e-3;
constexpr double kTurnSearchSettle_s = 0.3;
constexpr double kTurnSearchLower_s = 2;
constexpr double kTurnSearchDropped_m = 0.15e-3;
// While it turns, the part is led around a small circle, since its place is not known better than by sight.
constexpr double kCircle_m = 0.05e-3, kCircle_rad_s = 9;
}  // namespace

void TurnSearch::start(const Situation& situation, const Feel& feel) noexcept {
  situation_ = situation;
  start_s_ = feel.time_s;
  settled_s_ = turn_rad_ = 0;
  side_ = first_side_ = situation.attempt % 2 == 0 ? 1 : -1;
  reach_rad_ = kStep_rad;
  level_m_ = feel.along_m;
  move_ = {};
  move_.speed_m_s = kTurnSearchCreep_m_s;
  move_.push_N = situation.habits.search_N;
}

Outcome TurnSearch::step(const Feel& feel, double dt_s) noexcept {
  const double t_s = feel.time_s - start_s_;
  const bool is_lowered = feel.resist_N > 0.5 * situation_.habits.search_N || t_s > kTurnSearchLower_s;
  if (settled_s_ < kTurnSearchSettle_s) {
    if (isPastMouth(feel)) return Outcome::Done;
    settled_s_ = is_lowered ? settled_s_ + dt_s : 0;
    level_m_ = feel.along_m;
    return Outcome::GoingOn;
  }
  if (feel.along_m > level_m_ + kTurnSearchDropped_m) return Outcome::Done;
  turn_rad_ += side_ * kSpeed_rad_s * dt_s;
  if (side_ * turn_rad_ > reach_rad_) {
    if (reach_rad_ >= situation_.habits.turn_limit_rad && side_ != first_side_) return Outcome::Failed;
    if (side_ != first_side_) reach_rad_ = std::min(situation_.habits.turn_limit_rad, reach_rad_ + kStep_rad);
    side_ = -side_;
  }
  const Vec3 x = situation_.axis_W.unitOrthogonal(), y = situation_.axis_W.cross(x);
  move_.turn_rad = turn_rad_ * situation_.axis_W;
  move_.across_m = kCircle_m * (std::cos(kCircle_rad_s * t_s) * x + std::sin(kCircle_rad_s * t_s) * y);
  return Outcome::GoingOn;
}

}  // namespace vps::device
