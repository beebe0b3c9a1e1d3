// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "operator/strategies/strategy.h"

namespace vps::device {
namespace {

constexpr double kGain_per_s = 1.2, kSpeedMost_m_s = 5e-3;
constexpr double kCome_s = 2, kHold_s = 3;  // ten fixations at the target
constexpr double kMost_s = 15;              // assumed: after this time a person leaves a part that sticks
constexpr double kLeastError_m = 10e-6;     // assumed: a hand does not place a part more finely
// The seen distance is 0.35 s late: see_delay_s, and the time constant kSoon_s in person.cpp. A part at a
// distance g before its target moves at 1.2 g per second, and is seen 0.42 g behind its position. Averaged
// over three seconds, while g falls as exp(-1.2 t), this lag is 0.11 g: less than see_error_m if g is at most
// kHasCome times see_error_m.
constexpr double kHasCome = 8;

/// Holds the part where it is seen at its target, since no contact tells the position of the target. While
/// the part moves to the target, each picture is used without averaging. Afterwards the hand averages, over
/// all pictures, the position of the target relative to the felt position of the part: the hand overcomes
/// friction by pushing on, and the noise of sight does not move the part. Pictures of a fast part do not
/// count, since the picture is late and the sense of touch is not.
class PlaceBySight final : public Strategy {
 public:
  Outcome step(const Feel& feel, double dt_s) noexcept override {
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

 private:
  void begin(const Feel&) noexcept override {
    home_m_ = held_s_ = 0;
    move_.looks = true;
    move_.push_N = situation_.push_limit_N;
  }

  double home_m_ = 0;  ///< mean of `along_m` at the target, as seen
  double held_s_ = 0;  ///< duration of the mean home_m_; 0: the part still moves to the target
};

}  // namespace

std::unique_ptr<Strategy> makePlaceBySight() {
  return std::make_unique<PlaceBySight>();
}

}  // namespace vps::device
