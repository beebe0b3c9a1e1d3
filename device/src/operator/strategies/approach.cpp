// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "operator/strategies/strategy.h"

namespace vps::device {
namespace {

constexpr double kHover_s = 1;  // about three times fixation_s
// Nearer to the target than this, the part moves slowly, so that the delayed pictures keep up with it. The
// value is 15 times the default see_error_m.
constexpr double kApproachNear_m = 1.5e-3;
constexpr double kCare = 0.6;  // share of the insertion speed, as the part may hit an edge
constexpr double kSlow_m_s = 3e-3;
constexpr double kApproachTouch_s = 0.02;  // duration of resistance that counts as contact: shorter than a
                                           // tap, longer than the jerk at the start of a motion
// If the part is seen farther beyond its target than this multiple of see_error_m, nothing stops it there.
constexpr double kOvershoot = 4;

/// Hovers until the part has been seen for long enough, then moves ahead until the part touches, slowly near
/// the target.
class Approach final : public Strategy {
 public:
  Outcome step(const Feel& feel, double dt_s) noexcept override {
    const OperatorHabits& habits = situation_.habits;
    const bool is_near = std::min(feel.seen_short_m, -feel.along_m) < kApproachNear_m;
    move_.speed_m_s = !situation_.has_touched && feel.time_s < start_s_ + kHover_s ? 0
                      : is_near                                                    ? kSlow_m_s
                                : kCare * habits.insert_share * habits.speed_m_s;
    if (touch_.step(feel.resist_N > habits.touch_N, dt_s) > kApproachTouch_s) return Outcome::Done;
    const bool is_beyond = feel.seen_short_m < -kOvershoot * habits.see_error_m;
    return is_beyond ? Outcome::Unopposed : Outcome::GoingOn;
  }

 private:
  void begin(const Feel&) noexcept override {
    touch_ = {};
    move_.looks = !situation_.has_touched;
    move_.push_N = situation_.push_limit_N;
  }

  Held touch_;
};

}  // namespace

std::unique_ptr<Strategy> makeApproach() {
  return std::make_unique<Approach>();
}

}  // namespace vps::device
