// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "operator/strategies/strategies.h"

namespace vps::device {

namespace {
constexpr double kRate_N_per_s = 6;  // growth of the push
constexpr double kAlignByTorqueCreep_m_s = 25e-3;
constexpr double kFree_s = 0.1;
constexpr double kWobble_rad = 3e-3;  // about the error of sight in rotation
constexpr double kWobble_rad_s = 20;  // three turns a second
}  // namespace

void AlignByTorque::start(const Situation& situation, const Feel& feel) noexcept {
  situation_ = situation;
  start_s_ = feel.time_s;
  free_.reset();
  progress_.start(feel.along_m, feel.time_s);
  move_ = {};
  move_.speed_m_s = kAlignByTorqueCreep_m_s;
  move_.push_N = situation.habits.search_N;
  move_.gives_way = true;
}

Outcome AlignByTorque::step(const Feel& feel, double dt_s) noexcept {
  const double t_s = feel.time_s - start_s_;
  const double stuck_s = progress_.step(feel.along_m, feel.time_s, situation_.habits.progress_m);
  move_.push_N = std::min(situation_.push_limit_N, move_.push_N + dt_s * kRate_N_per_s);
  const Vec3 x = situation_.axis_W.unitOrthogonal(), y = situation_.axis_W.cross(x);
  const double wobble_rad = stuck_s > 0.1 ? kWobble_rad : 0;
  move_.turn_rad = wobble_rad * (std::cos(kWobble_rad_s * t_s) * x + std::sin(kWobble_rad_s * t_s) * y);
  // Nothing resists any more: the hole lets the part go on.
  if (free_.step(feel.resist_N < 0.3 * situation_.habits.touch_N, dt_s) > kFree_s) return Outcome::Done;
  const bool is_full = move_.push_N >= situation_.push_limit_N;
  return is_full && stuck_s > situation_.habits.stuck_s ? Outcome::Done : Outcome::GoingOn;
}

}  // namespace vps::device
