// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numbers>

#include "operator/strategies/strategy.h"

namespace vps::device {
namespace {

constexpr double kSpiralSpeed_m_s = 2.5e-3;  // speed along the spiral
constexpr double kTurnMost_rad_s = 12;       // limit near the centre: two turns a second
// Depth of a drop of a slender part. The edge of a slender part that sways rises and falls by less.
constexpr double kSlenderDropped_m = 0.3e-3;
/// Friction holds a part that is pressed on the surface, and a spring couples the hand to it. The hand feels
/// where the part is, and moves ahead of the part until the part follows.
constexpr double kLead_per_s = 15;
constexpr double kMostLead_m = 1.5e-3;
/// Friction of 0.5 N leans a slender part by this angle. assumed: 1.2 N m/rad at 0.1 m
constexpr double kMostLead_rad = 0.04;

/// Slides the part over the surface in an Archimedean spiral until it drops.
class SpiralSearch final : public Strategy {
 public:
  [[nodiscard]] bool isSearch() const noexcept override { return true; }

  Outcome step(const Feel& feel, double dt_s) noexcept override {
    wait_s_ += dt_s;
    const bool is_lowered = feel.resist_N >= 0.5 * situation_.habits.search_N || wait_s_ >= kLower_s;
    if (!is_lowered || wait_s_ < kSettle_s) {
      if (isPastMouth(feel)) return Outcome::Done;
      level_m_ = feel.along_m;
      if (!situation_.is_slender) center_m_ = feel.tip_m;
      return Outcome::GoingOn;
    }
    if (feel.along_m > level_m_ + (situation_.is_slender ? kSlenderDropped_m : kDropped_m))
      return Outcome::Done;
    const double radius_m = situation_.habits.search_m * angle_rad_ / (2 * std::numbers::pi);
    if (radius_m > situation_.habits.search_limit_m) return Outcome::Failed;
    angle_rad_ += dt_s * std::min(kTurnMost_rad_s, kSpiralSpeed_m_s / std::max(radius_m, 1e-9));
    const Vec3 at_m = radius_m * acrossAxis(situation_.axis_W, angle_rad_);
    lead_m_ += kLead_per_s * dt_s * (at_m - (feel.tip_m - center_m_));
    const double most_m = kMostLead_m + (situation_.is_slender ? kMostLead_rad * situation_.tip_m : 0);
    if (const double length_m = lead_m_.norm(); length_m > most_m) lead_m_ *= most_m / length_m;
    move_.across_m = at_m + lead_m_;
    return Outcome::GoingOn;
  }

 private:
  void begin(const Feel& feel) noexcept override {
    angle_rad_ = wait_s_ = 0;
    lead_m_ = Vec3::Zero();
    center_m_ = situation_.is_slender ? Vec3(Vec3::Zero()) : feel.tip_m;
    level_m_ = feel.along_m;
    pressLightly();
  }

  double angle_rad_ = 0, wait_s_ = 0, level_m_ = 0;
  Vec3 center_m_ = Vec3::Zero();  ///< centre of the spiral
  Vec3 lead_m_ = Vec3::Zero();    ///< lead of the hand ahead of the part
};

}  // namespace

std::unique_ptr<Strategy> makeSpiralSearch() {
  return std::make_unique<SpiralSearch>();
}

}  // namespace vps::device
