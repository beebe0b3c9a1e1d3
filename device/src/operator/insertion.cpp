// SPDX-License-Identifier: BSD-3-Clause
#include "operator/insertion.h"

#include <algorithm>

namespace vps::device {

namespace {

constexpr int kLittleBackOffs = 3;   // then it withdraws whole
constexpr double kDeeper_m = 2e-3;   // beyond one mouth there may be another one
constexpr double kFreeWay_m = 3e-3;  // three times as far as it backs off: it had left the first hole
constexpr int kSearchesDeeper = 4;   // at one place, before it withdraws to the first mouth

}  // namespace

void Insertion::reset() noexcept {
  has_aligned_ = false;
  stuck_inside_ = searches_ = searches_deeper_ = 0;
  first_mouth_m_ = approach_from_m_ = 0;
}

Strategy& Insertion::present() noexcept {
  switch (strategy_) {
    case OperatorStrategy::TiltIn:
      return tilt_in_;
    case OperatorStrategy::SpiralSearch:
      return spiral_search_;
    case OperatorStrategy::TurnSearch:
      return turn_search_;
    case OperatorStrategy::AlignByTorque:
      return align_;
    case OperatorStrategy::BackOff:
      if (is_whole_) return back_off_whole_;
      return back_off_little_;
    case OperatorStrategy::PressHome:
      return press_home_;
    default:
      return Sequence::present();
  }
}

void Insertion::prepare() noexcept {
  const OperatorHabits& habits = situation_.habits;
  situation_.push_limit_N = std::min(habits.force_limit_N, habits.press_N * (1 + 0.5 * (retries_ % 5)));
  situation_.attempt = searches_ / 2;
}

bool Insertion::isFree(const Feel& feel) const noexcept {
  return feel.resist_N < 0.5 * situation_.habits.touch_N;
}

void Insertion::next(bool succeeded, const Feel& feel) noexcept {
  switch (strategy_) {
    case OperatorStrategy::Approach:
      if (succeeded && !situation_.has_touched) first_mouth_m_ = feel.along_m;
      if (succeeded) noteNextMouth(feel);
      return afterApproach(succeeded, feel);
    case OperatorStrategy::Touch:
      return afterTouch(feel);
    case OperatorStrategy::TiltIn:
    case OperatorStrategy::SpiralSearch:
    case OperatorStrategy::TurnSearch:
      return succeeded ? start(OperatorStrategy::AlignByTorque, feel) : backOff(true, feel);
    case OperatorStrategy::AlignByTorque:
      approach_from_m_ = feel.along_m;
      return start(isFree(feel) ? OperatorStrategy::Approach : OperatorStrategy::Touch, feel);
    case OperatorStrategy::BackOff:
      approach_from_m_ = feel.along_m;
      if (!is_whole_) return start(OperatorStrategy::AlignByTorque, feel);
      return start(nextSearch(), feel);
    case OperatorStrategy::PressHome:
      return press_home_.hasYielded() ? start(OperatorStrategy::PlaceBySight, feel) : backOff(false, feel);
    default:
      return;
  }
}

// In turn: tilt in, spiral search, for a part with corners turn search, and straight ahead again.
OperatorStrategy Insertion::nextSearch() const noexcept {
  const int count = situation_.has_corners ? 4 : 3;
  switch (searches_ % count) {
    case 0:
      return OperatorStrategy::Approach;
    case 1:
      return situation_.corner_W.isZero() ? OperatorStrategy::SpiralSearch : OperatorStrategy::TiltIn;
    case 2:
      return OperatorStrategy::SpiralSearch;
    default:
      return OperatorStrategy::TurnSearch;
  }
}

// A ring that has passed one land of a stepped shaft goes on freely until it meets the next one. Its search
// begins there, and not before the first land, which it would have to pass again.
void Insertion::noteNextMouth(const Feel& feel) noexcept {
  const bool went_freely = feel.along_m > approach_from_m_ + kFreeWay_m;
  if (situation_.is_slender || !went_freely || feel.along_m < situation_.mouth_m + kDeeper_m) return;
  if (!situation_.has_touched) return;
  situation_.mouth_m = feel.along_m;
  has_aligned_ = false;
  stuck_inside_ = searches_ = searches_deeper_ = 0;
}

// The part touches and slides no farther: is it home, in the hole, or beside it?
void Insertion::afterTouch(const Feel& feel) noexcept {
  if (std::abs(feel.seen_short_m) < situation_.near_m) return start(OperatorStrategy::PressHome, feel);
  if (!has_aligned_) {
    has_aligned_ = true;
    return start(OperatorStrategy::AlignByTorque, feel);
  }
  const bool is_inside = feel.along_m > situation_.mouth_m + kInside_m;
  if (is_inside && situation_.is_slender) return afterTouchInside(feel);
  backOff(!is_inside || ++stuck_inside_ % (kLittleBackOffs + 1) == 0, feel);
}

// A long part that has passed one wall may stand before the next one, whose hole it has to find as it found
// the first; or it is jammed in the first.
void Insertion::afterTouchInside(const Feel& feel) noexcept {
  const bool is_deeper = feel.along_m > situation_.mouth_m + kDeeper_m;
  if (is_deeper && ++stuck_inside_ % 2 == 0) {
    situation_.mouth_m = feel.along_m;
    searches_ = searches_deeper_ = 0;
    return backOff(true, feel);
  }
  backOff(!is_deeper && stuck_inside_++ % (kLittleBackOffs + 1) == 0, feel);
}

void Insertion::backOff(bool is_whole, const Feel& feel) noexcept {
  ++retries_;
  is_whole_ = is_whole;
  if (is_whole) {
    ++searches_;
    if (situation_.mouth_m > first_mouth_m_ && ++searches_deeper_ > kSearchesDeeper) {
      situation_.mouth_m = first_mouth_m_;
      searches_deeper_ = 0;
    }
    has_aligned_ = false;
  }
  start(OperatorStrategy::BackOff, feel);
}

}  // namespace vps::device
