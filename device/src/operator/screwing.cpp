// SPDX-License-Identifier: BSD-3-Clause
#include "operator/screwing.h"

#include <algorithm>

namespace vps::device::inline v0 {

namespace {

// Somewhere in one turn both threads' ends meet; the rest is for the play of the hand.
constexpr double kBack_rad = 1.25 * 6.283185307179586;

}  // namespace

void Screwing::begin(const Situation& situation, const Feel& feel) noexcept {
  situation_ = situation;
  retries_ = 0;
  is_coming_off_ = false;
  start(OperatorStrategy::Approach, feel);
}

Strategy& Screwing::present() noexcept {
  switch (strategy_) {
    case OperatorStrategy::Touch:
      return touch_;
    case OperatorStrategy::TurnBack:
      return turn_back_;
    case OperatorStrategy::ScrewOn:
      return screw_on_;
    case OperatorStrategy::BackOff:
      return back_off_;
    case OperatorStrategy::PlaceBySight:
      return place_by_sight_;
    default:
      return approach_;
  }
}

void Screwing::start(OperatorStrategy strategy, const Feel& feel) noexcept {
  strategy_ = strategy;
  situation_.push_limit_N = situation_.habits.press_N;
  situation_.attempt = retries_;
  situation_.back_rad = kBack_rad + (is_coming_off_ ? std::max(0.0, screw_on_.turned_rad()) : 0);
  present().start(situation_, feel);
}

Outcome Screwing::step(const Feel& feel, double dt_s) noexcept {
  const Outcome outcome = present().step(feel, dt_s);
  if (outcome == Outcome::GoingOn) return outcome;
  const bool is_last = strategy_ == OperatorStrategy::ScrewOn || strategy_ == OperatorStrategy::PlaceBySight;
  if (is_last && outcome == Outcome::Done) return Outcome::Done;
  next(outcome == Outcome::Done, feel);
  return Outcome::GoingOn;
}

void Screwing::next(bool succeeded, const Feel& feel) noexcept {
  switch (strategy_) {
    case OperatorStrategy::Approach:
      if (!succeeded) return start(OperatorStrategy::PlaceBySight, feel);
      if (!situation_.has_touched) situation_.mouth_m = feel.along_m;
      situation_.has_touched = true;
      return start(OperatorStrategy::Touch, feel);
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

}  // namespace vps::device::inline v0
