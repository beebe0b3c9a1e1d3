// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "operator/strategies/strategies.h"

namespace vps::device {

namespace {
constexpr double kSpiralSearchSpeed_m_s = 2.5e-3;  // along the spiral
constexpr double kTurnMost_rad_s = 12;             // near its centre: two turns a second
constexpr double kSpiralSearchCreep_m_s = 10e-3;
constexpr double kSpiralSearchSettle_s = 0.3;
constexpr double kSpiralSearchDropped_m = 0.15e-3;
constexpr double kSlenderDropped_m =
    0.3e-3;  // while it leans from one side to the other, its edge rises and falls
/// Friction holds a part that is pressed on the surface, and the hand, which is coupled to it by a spring,
/// has to lead it. The hand feels where the part is, and leads it farther until it follows.
constexpr double kLead_per_s = 15;
constexpr double kMostLead_m = 1.5e-3;
constexpr double kMostLead_rad =
    0.04;  // friction of 0.5 N leans a slender part by that: assumed, 1.2 N m/rad at 0.1 m
}  // namespace

void SpiralSearch::start(const Situation& situation, const Feel& feel) noexcept {
  situation_ = situation;
  angle_rad_ = wait_s_ = 0;
  lead_m_ = Vec3::Zero();
  center_m_ = situation.is_slender ? Vec3(Vec3::Zero()) : feel.tip_m;
  level_m_ = feel.along_m;
  move_ = {};
  move_.speed_m_s = kSpiralSearchCreep_m_s;
  move_.push_N = situation.habits.search_N;
}

Outcome SpiralSearch::step(const Feel& feel, double dt_s) noexcept {
  constexpr double kTurn_rad = 6.283185307179586;
  wait_s_ += dt_s;
  const bool is_lowered = feel.resist_N >= 0.5 * situation_.habits.search_N || wait_s_ >= 2;
  if (!is_lowered || wait_s_ < kSpiralSearchSettle_s) {
    if (isPastMouth(feel)) return Outcome::Done;
    level_m_ = feel.along_m;
    if (!situation_.is_slender) center_m_ = feel.tip_m;
    return Outcome::GoingOn;
  }
  if (feel.along_m > level_m_ + (situation_.is_slender ? kSlenderDropped_m : kSpiralSearchDropped_m))
    return Outcome::Done;
  const double pitch_m = situation_.habits.search_m, radius_m = pitch_m * angle_rad_ / kTurn_rad;
  if (radius_m > situation_.habits.search_limit_m) return Outcome::Failed;
  angle_rad_ += dt_s * std::min(kTurnMost_rad_s, kSpiralSearchSpeed_m_s / std::max(radius_m, 1e-9));
  const Vec3 x = situation_.axis_W.unitOrthogonal(), y = situation_.axis_W.cross(x);
  const Vec3 at_m = radius_m * (std::cos(angle_rad_) * x + std::sin(angle_rad_) * y);
  lead_m_ += kLead_per_s * dt_s * (at_m - (feel.tip_m - center_m_));
  const double most_m = kMostLead_m + (situation_.is_slender ? kMostLead_rad * situation_.tip_m : 0);
  if (const double length_m = lead_m_.norm(); length_m > most_m) lead_m_ *= most_m / length_m;
  move_.across_m = at_m + lead_m_;
  return Outcome::GoingOn;
}

}  // namespace vps::device
