// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "operator/strategies/strategies.h"

namespace vps::device {

namespace {
constexpr double kGain_per_s = 1.2, kSpeedMost_m_s = 5e-3;
constexpr double kCome_s = 2, kHold_s = 3;  // ten fixations at the target
constexpr double kMost_s = 15;              // assumed: then a person leaves a part that sticks where it is
constexpr double kLeastError_m = 10e-6;     // assumed: a hand does not place more finely
// What is seen is 0.35 s late. A part that still lacks g to its target comes at 1.2 g a second, and is seen
// 0.42 g behind its place. In the mean of three seconds, while g falls as exp(-1.2 t), that is 0.11 g: less
// than an error of sight where g is eight of them.
constexpr double kHasCome = 8;
}  // namespace

void PlaceBySight::start(const Situation& situation, const Feel& feel) noexcept {
  situation_ = situation;
  start_s_ = feel.time_s;
  home_m_ = held_s_ = 0;
  move_ = {};
  move_.looks = true;
  move_.push_N = situation.push_limit_N;
}

// While the part comes, what is seen counts as it is. Then the hand averages, over all that it sees, where
// the part belongs relative to where it is felt to be: friction that holds the part is overcome by pushing
// on, and the noise of sight does not move it. What is seen is late, and does not fit what is felt while the
// part is fast.
Outcome PlaceBySight::step(const Feel& feel, double dt_s) noexcept {
  const double t_s = feel.time_s - start_s_;
  const double error_m = std::max(situation_.habits.see_error_m, kLeastError_m);
  const double near_m = kHasCome * error_m;
  const bool has_come = held_s_ > 0 || (t_s > kCome_s && std::abs(feel.seen_short_m) < near_m);
  if (has_come && std::abs(feel.speed_m_s) < kGain_per_s * near_m) {
    held_s_ += dt_s;
    home_m_ += dt_s / held_s_ * (feel.seen_short_m + feel.along_m - home_m_);
  }
  const double short_m = held_s_ > 0 ? home_m_ - feel.along_m : feel.seen_short_m;
  move_.speed_m_s = std::clamp(kGain_per_s * short_m, -kSpeedMost_m_s, kSpeedMost_m_s);
  const bool is_home = held_s_ > kHold_s - 0.5 * dt_s && std::abs(short_m) < error_m;
  if (!is_home && t_s < kMost_s) return Outcome::GoingOn;
  move_.speed_m_s = 0;
  return Outcome::Done;
}

}  // namespace vps::device
