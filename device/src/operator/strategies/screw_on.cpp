// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numbers>

#include "operator/strategies/strategy.h"

namespace vps::device {
namespace {

constexpr double kScrewOn_rad_s = 1.2;    // assumed, as in TurnBack
constexpr double kScrewNear_rad_s = 0.6;  // near the target, so that sight can follow
constexpr double kScrewNear_m = 0.5e-3;
constexpr double kCaughtTurns = 1;  // the part must follow the thread after these turns
constexpr double kCheckTurns = 0.5;
constexpr double kStall_rad = 0.01, kStall_s = 0.5;
constexpr double kJamShare = 0.6;  // share of the hand's greatest torque

/// Turns the part onto the thread, and compares its advance along the axis with the pitch. Done: the part is
/// seen at its target, or it is tight. Failed: the part does not follow the thread, leans, or is stuck.
class ScrewOn final : public Strategy {
 public:
  Outcome step(const Feel& feel, double dt_s) noexcept override {
    const OperatorHabits& habits = situation_.habits;
    const double onward = turnsOn(situation_.screw);
    if (grips_ != feel.grips) {  // the hand has just closed again
      grips_ = feel.grips;
      start_s_ = feel.time_s;
    }
    const double turned_rad = onward * (feel.spin_rad - from_rad_);
    // Sight is delayed and noisy; the felt motion is neither.
    short_m_ += std::min(1.0, dt_s / kLook_s) * (feel.seen_short_m - short_m_) - (feel.along_m - along_m_);
    along_m_ = feel.along_m;
    const bool is_settled = feel.time_s > start_s_ + kSettle_s;
    const bool is_near = short_m_ < kScrewNear_m;
    move_.spin_rad_s = is_settled ? onward * (is_near ? kScrewNear_rad_s : kScrewOn_rad_s) : 0;
    if (!is_settled) {
      turning_.start(turned_rad, feel.time_s);
      return Outcome::GoingOn;
    }
    const double torque_Nm = -onward * feel.twist_Nm;
    const bool is_tight = situation_.screw.torque_Nm > 0 && torque_Nm >= situation_.screw.torque_Nm;
    const bool is_there = situation_.screw.torque_Nm <= 0 && short_m_ <= 0;
    if (is_tight || is_there) {
      move_.spin_rad_s = 0;
      return Outcome::Done;
    }
    const bool is_stuck = turning_.step(turned_rad, feel.time_s, kStall_rad) > kStall_s &&
                          torque_Nm > kJamShare * habits.torque_limit_Nm;
    return is_stuck || (feel.lean_rad - lean_rad_).norm() > ScrewTask::kCrossedLean_rad ||
                   !followsThread(feel)
               ? Outcome::Failed
               : Outcome::GoingOn;
  }

 private:
  void begin(const Feel& feel) noexcept override {
    from_rad_ = mark_rad_ = feel.spin_rad;
    mark_m_ = along_m_ = feel.along_m;
    short_m_ = feel.seen_short_m;
    lean_rad_ = feel.lean_rad;
    grips_ = feel.grips;
    has_caught_ = false;
    turning_.start(0, feel.time_s);
    pressLightly();
    move_.gives_way = true;
  }

  /// Compares the advance along the axis since the last comparison with the pitch. The first comparison is
  /// made after a whole turn, when the play of the thread is taken up.
  [[nodiscard]] bool followsThread(const Feel& feel) noexcept {
    const double turns = turnsOn(situation_.screw) * (feel.spin_rad - mark_rad_) / (2 * std::numbers::pi);
    if (turns < (has_caught_ ? kCheckTurns : kCaughtTurns)) return true;
    const double wanted_m = turns * std::abs(situation_.screw.pitch_m);
    const bool follows = std::abs(feel.along_m - mark_m_ - wanted_m) < ScrewTask::kOffPitch * wanted_m;
    has_caught_ = true;
    mark_rad_ = feel.spin_rad;
    mark_m_ = feel.along_m;
    return follows;
  }

  double from_rad_ = 0, mark_rad_ = 0, mark_m_ = 0, along_m_ = 0, short_m_ = 0;
  Vec3 lean_rad_ = Vec3::Zero();
  int grips_ = 0;
  bool has_caught_ = false;
  Progress turning_;
};

}  // namespace

std::unique_ptr<Strategy> makeScrewOn() {
  return std::make_unique<ScrewOn>();
}

}  // namespace vps::device
