// SPDX-License-Identifier: BSD-3-Clause
#include "operator/sequence.h"

#include <algorithm>
#include <numbers>

namespace vps::device {
namespace {

// Within one turn both threads' ends meet; the additional quarter turn is for the play of the hand.
constexpr double kBack_rad = 1.25 * 2 * std::numbers::pi;

}  // namespace

#define VPS_MAKE(Name, name) , make##Name()
Sequence::Sequence() : strategies_{nullptr VPS_OPERATOR_STRATEGIES(VPS_MAKE)} {}
#undef VPS_MAKE

void Sequence::begin(const Situation& situation, const Feel& feel) noexcept {
  situation_ = situation;
  earlier_retries_ += retries_;
  retries_ = 0;
  reset();
  start(OperatorStrategy::Approach, feel);
}

void Sequence::start(OperatorStrategy strategy, const Feel& feel) noexcept {
  strategy_ = strategy;
  prepare();
  of(strategy).start(situation_, feel);
}

Outcome Sequence::step(const Feel& feel, double dt_s) noexcept {
  const Outcome outcome = of(strategy_).step(feel, dt_s);
  if (outcome == Outcome::GoingOn) return outcome;
  if (isAtLastStrategy() && outcome == Outcome::Done) return Outcome::Done;
  if (outcome == Outcome::Unopposed)
    start(OperatorStrategy::PlaceBySight, feel);
  else
    next(outcome == Outcome::Done, feel);
  return Outcome::GoingOn;
}

void Sequence::startTouch(const Feel& feel) noexcept {
  if (!situation_.has_touched) situation_.mouth_m = feel.along_m;
  situation_.has_touched = true;
  start(OperatorStrategy::Touch, feel);
}

void Screwing::prepare() noexcept {
  situation_.push_limit_N = situation_.habits.press_N;
  situation_.attempt = retries_;
  situation_.back_rad = kBack_rad + (is_coming_off_ ? std::max(0.0, screwed_rad_) : 0);
}

void Screwing::next(bool, const Feel& feel) noexcept {
  switch (strategy_) {
    case OperatorStrategy::Approach:
      return startTouch(feel);
    case OperatorStrategy::Touch:
      return start(OperatorStrategy::TurnBack, feel);
    case OperatorStrategy::TurnBack:
      if (is_coming_off_) return start(OperatorStrategy::BackOff, feel);
      // ScrewOn follows also without a drop: a drop into a worn or tight thread may be too small to feel.
      screwed_from_rad_ = feel.spin_rad;
      return start(OperatorStrategy::ScrewOn, feel);
    case OperatorStrategy::ScrewOn:
      screwed_rad_ = turnsOn(situation_.screw) * (feel.spin_rad - screwed_from_rad_);
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
