// SPDX-License-Identifier: BSD-3-Clause
#include "operator/sequence.h"

namespace vps::device {

void Sequence::begin(const Situation& situation, const Feel& feel) noexcept {
  situation_ = situation;
  earlier_retries_ += retries_;
  retries_ = 0;
  reset();
  start(OperatorStrategy::Approach, feel);
}

Strategy& Sequence::present() noexcept {
  if (strategy_ == OperatorStrategy::Touch) return touch_;
  if (strategy_ == OperatorStrategy::PlaceBySight) return place_by_sight_;
  return approach_;
}

void Sequence::start(OperatorStrategy strategy, const Feel& feel) noexcept {
  strategy_ = strategy;
  prepare();
  present().start(situation_, feel);
}

Outcome Sequence::step(const Feel& feel, double dt_s) noexcept {
  const Outcome outcome = present().step(feel, dt_s);
  if (outcome == Outcome::GoingOn) return outcome;
  const bool is_last = strategy_ == OperatorStrategy::PressHome || strategy_ == OperatorStrategy::ScrewOn ||
                       strategy_ == OperatorStrategy::PlaceBySight;
  if (is_last && outcome == Outcome::Done) return Outcome::Done;
  next(outcome == Outcome::Done, feel);
  return Outcome::GoingOn;
}

void Sequence::afterApproach(bool has_touched, const Feel& feel) noexcept {
  if (!has_touched) return start(OperatorStrategy::PlaceBySight, feel);
  if (!situation_.has_touched) situation_.mouth_m = feel.along_m;
  situation_.has_touched = true;
  start(OperatorStrategy::Touch, feel);
}

}  // namespace vps::device
