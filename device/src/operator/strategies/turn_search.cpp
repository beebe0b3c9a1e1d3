// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "operator/strategies/strategy.h"

namespace vps::device {
namespace {

constexpr double kSpeed_rad_s = 0.12;  // slow enough that the part drops within its clearance
// Each sweep is longer by this angle than the last sweep to the same side.
constexpr double kStep_rad = 0.035;
// While it turns, the part is moved around a small circle, since its position is wrong by about see_error_m.
constexpr double kCircle_m = 0.05e-3, kCircle_rad_s = 9;

/// Presses the part lightly on the surface and turns it about the axis of insertion, to and fro and farther
/// each time, until it drops.
class TurnSearch final : public Strategy {
 public:
  [[nodiscard]] bool isSearch() const noexcept override { return true; }
  [[nodiscard]] bool suits(const Situation& situation) const noexcept override {
    return situation.has_corners;
  }
  [[nodiscard]] bool findsByOffset() const noexcept override { return true; }

  Outcome step(const Feel& feel, double dt_s) noexcept override {
    const double t_s = feel.time_s - start_s_;
    const bool is_lowered = feel.resist_N > 0.5 * situation_.habits.search_N || t_s > kLower_s;
    if (settled_s_ < kSettle_s) {
      if (isPastMouth(feel)) return Outcome::Done;
      settled_s_ = is_lowered ? settled_s_ + dt_s : 0;
      level_m_ = feel.along_m;
      return Outcome::GoingOn;
    }
    if (feel.along_m > level_m_ + kDropped_m) return Outcome::Done;
    const double limit_rad = situation_.habits.turn_limit_rad;
    turn_rad_ += side_ * kSpeed_rad_s * dt_s;
    if (side_ * turn_rad_ > reach_rad_) {
      if (reach_rad_ >= limit_rad && side_ != first_side_) return Outcome::Failed;
      if (side_ != first_side_) reach_rad_ = std::min(limit_rad, reach_rad_ + kStep_rad);
      side_ = -side_;
    }
    move_.turn_rad = turn_rad_ * situation_.axis_W;
    move_.across_m = kCircle_m * acrossAxis(situation_.axis_W, kCircle_rad_s * t_s);
    return Outcome::GoingOn;
  }

 private:
  void begin(const Feel& feel) noexcept override {
    settled_s_ = turn_rad_ = 0;
    side_ = first_side_ = situation_.attempt % 2 == 0 ? 1 : -1;
    reach_rad_ = kStep_rad;
    level_m_ = feel.along_m;
    pressLightly();
  }

  double settled_s_ = 0, level_m_ = 0;
  double turn_rad_ = 0, reach_rad_ = 0;  ///< present angle, and where the present sweep ends
  int side_ = 1, first_side_ = 1;
};

}  // namespace

std::unique_ptr<Strategy> makeTurnSearch() {
  return std::make_unique<TurnSearch>();
}

}  // namespace vps::device
