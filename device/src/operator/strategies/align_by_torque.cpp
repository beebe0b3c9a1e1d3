// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "operator/strategies/strategy.h"

namespace vps::device {
namespace {

constexpr double kRate_N_per_s = 6;  // growth of the push
constexpr double kAlignSpeed_m_s = 25e-3;
constexpr double kFree_s = 0.1;
constexpr double kWobble_rad = 3e-3;  // amplitude, about see_error_rad
constexpr double kWobble_rad_s = 20;  // three rotations per second

/// Pushes and yields to side force and torque, with a small wobble against friction, until the part stops
/// advancing or meets no resistance.
class AlignByTorque final : public Strategy {
 public:
  Outcome step(const Feel& feel, double dt_s) noexcept override {
    const double t_s = feel.time_s - start_s_;
    const double stuck_s = progress_.step(feel.along_m, feel.time_s, situation_.habits.progress_m);
    move_.push_N = std::min(situation_.push_limit_N, move_.push_N + dt_s * kRate_N_per_s);
    const double wobble_rad = stuck_s > 0.1 ? kWobble_rad : 0;
    move_.turn_rad = wobble_rad * acrossAxis(situation_.axis_W, kWobble_rad_s * t_s);
    if (free_.step(feel.resist_N < 0.3 * situation_.habits.touch_N, dt_s) > kFree_s) return Outcome::Done;
    const bool is_full = move_.push_N >= situation_.push_limit_N;
    return is_full && stuck_s > situation_.habits.stuck_s ? Outcome::Done : Outcome::GoingOn;
  }

 private:
  void begin(const Feel& feel) noexcept override {
    free_ = {};
    progress_.start(feel.along_m, feel.time_s);
    move_.speed_m_s = kAlignSpeed_m_s;
    move_.push_N = situation_.habits.search_N;
    move_.gives_way = true;
  }

  Progress progress_;
  Held free_;
};

}  // namespace

std::unique_ptr<Strategy> makeAlignByTorque() {
  return std::make_unique<AlignByTorque>();
}

}  // namespace vps::device
