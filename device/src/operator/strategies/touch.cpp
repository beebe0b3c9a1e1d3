// SPDX-License-Identifier: BSD-3-Clause
#include "operator/strategies/strategy.h"

namespace vps::device {
namespace {

constexpr double kTouchLongest_s = 3;

/// Pushes lightly until the part stops sliding.
class Touch final : public Strategy {
 public:
  Outcome step(const Feel& feel, double) noexcept override {
    const double stuck_s = progress_.step(feel.along_m, feel.time_s, situation_.habits.progress_m);
    const bool is_over = stuck_s > situation_.habits.stuck_s || feel.time_s > start_s_ + kTouchLongest_s;
    return is_over ? Outcome::Done : Outcome::GoingOn;
  }

 private:
  void begin(const Feel& feel) noexcept override {
    progress_.start(feel.along_m, feel.time_s);
    pressLightly();
    move_.gives_way = true;
  }

  Progress progress_;
};

}  // namespace

std::unique_ptr<Strategy> makeTouch() {
  return std::make_unique<Touch>();
}

}  // namespace vps::device
