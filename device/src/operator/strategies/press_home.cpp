// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "operator/strategies/strategy.h"

namespace vps::device {
namespace {

constexpr double kRamp_s = 0.2;  // duration of increasing and of decreasing the press
// Share of the press that is kept until release, so that the part stays seated.
constexpr double kResidualShare = 0.15;
constexpr double kPressSpeed_m_s = 80e-3;  // reaches the press within kRamp_s; push_N limits the force
constexpr double kYields = 4;  // a part that is seen farther beyond its target than this multiple of
                               // see_error_m has yielded

/// Presses the part against its stop, and relaxes. Failed: the part is not seen near its target.
class PressHome final : public Strategy {
 public:
  Outcome step(const Feel& feel, double) noexcept override {
    const OperatorHabits& habits = situation_.habits;
    const double t_s = feel.time_s - start_s_, down_s = kRamp_s + habits.press_s;
    const double ramp = t_s < down_s ? minimumJerk(t_s / kRamp_s) : 1 - minimumJerk((t_s - down_s) / kRamp_s);
    move_.push_N = habits.press_N * (kResidualShare + (1 - kResidualShare) * ramp);
    if (feel.seen_short_m < -kYields * habits.see_error_m) return Outcome::Unopposed;
    if (t_s < down_s + kRamp_s + habits.see_delay_s + kLook_s) return Outcome::GoingOn;
    return std::abs(feel.seen_short_m) < situation_.near_m ? Outcome::Done : Outcome::Failed;
  }

 private:
  void begin(const Feel&) noexcept override {
    move_.speed_m_s = kPressSpeed_m_s;
    move_.push_N = situation_.habits.search_N;
    move_.gives_way = true;
  }
};

}  // namespace

std::unique_ptr<Strategy> makePressHome() {
  return std::make_unique<PressHome>();
}

}  // namespace vps::device
