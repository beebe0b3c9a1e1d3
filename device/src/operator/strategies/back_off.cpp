// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "operator/strategies/strategy.h"

namespace vps::device {
namespace {

constexpr double kBackOffSpeed_m_s = 15e-3;
constexpr double kBackOffLongest_s = 4;
// Longest time until the end of a slender part is in front of its hole.
constexpr double kBackOffLookLongest_s = 3;
constexpr double kBackOffNear_m = 0.1e-3;

/// Withdraws: a little within the hole, or to before its mouth, where the operator looks again.
class BackOff final : public Strategy {
 public:
  Outcome step(const Feel& feel, double dt_s) noexcept override {
    if (feel.time_s > start_s_ + longest_s_) return Outcome::Done;
    if (looked_s_ == 0 && feel.along_m > goal_m_ + kBackOffNear_m) return Outcome::GoingOn;
    move_.speed_m_s = 0;
    if (!situation_.backs_off_whole) return Outcome::Done;
    move_.gives_way = false;
    move_.looks = true;
    looked_s_ += dt_s;
    if (looked_s_ < kLook_s) return Outcome::GoingOn;
    const bool is_there = !situation_.is_slender || feel.tip_m.norm() < situation_.habits.see_error_m;
    return is_there || looked_s_ > kBackOffLookLongest_s ? Outcome::Done : Outcome::GoingOn;
  }

 private:
  void begin(const Feel& feel) noexcept override {
    looked_s_ = 0;
    const double from_m =
        situation_.backs_off_whole ? std::min(feel.along_m, situation_.mouth_m) : feel.along_m;
    goal_m_ = from_m - situation_.habits.back_off_m;
    longest_s_ = kBackOffLongest_s;
    if (situation_.is_slender)
      longest_s_ += kBackOffLookLongest_s + (feel.along_m - goal_m_) / kBackOffSpeed_m_s;
    move_.speed_m_s = -kBackOffSpeed_m_s;
    move_.gives_way = true;
  }

  double goal_m_ = 0, looked_s_ = 0, longest_s_ = 0;
};

}  // namespace

std::unique_ptr<Strategy> makeBackOff() {
  return std::make_unique<BackOff>();
}

}  // namespace vps::device
