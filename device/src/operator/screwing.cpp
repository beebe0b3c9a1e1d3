// SPDX-License-Identifier: BSD-3-Clause
#include "operator/screwing.h"

#include <algorithm>

namespace vps::device {

namespace {

// Somewhere in one turn both threads' ends meet; the rest is for the play of the hand.
constexpr double kBack_rad = 1.25 * 6.283185307179586;

}  // namespace

void Screwing::reset() noexcept {
  is_coming_off_ = false;
}

Strategy& Screwing::present() noexcept {
  switch (strategy_) {
    case OperatorStrategy::TurnBack:
      return turn_back_;
    case OperatorStrategy::ScrewOn:
      return screw_on_;
    case OperatorStrategy::BackOff:
      return back_off_;
    default:
      return Sequence::present();
  }
}

void Screwing::prepare() noexcept {
  situation_.push_limit_N = situation_.habits.press_N;
  situation_.attempt = retries_;
  situation_.back_rad = kBack_rad + (is_coming_off_ ? std::max(0.0, screw_on_.turned_rad()) : 0);
}

void Screwing::next(bool succeeded, const Feel& feel) noexcept {
  switch (strategy_) {
    case OperatorStrategy::Approach:
      return afterApproach(succeeded, feel);
    case OperatorStrategy::Touch:
      return start(OperatorStrategy::TurnBack, feel);
    case OperatorStrategy::TurnBack:
      // Without a drop it is tried all the same: a drop into a worn or tight thread may be too small to feel.
      return start(is_coming_off_ ? OperatorStrategy::BackOff : OperatorStrategy::ScrewOn, feel);
    case OperatorStrategy::ScrewOn:
      ++retries_;
      is_coming_off_ = true;
      return start(OperatorStrategy::TurnBack, feel);
    case OperatorStrategy::BackOff:
      is_coming_off_ = false;
      return start(OperatorStrategy::Approach, feel);
    default:
      return;
  }
}

}  // namespace vps::device
