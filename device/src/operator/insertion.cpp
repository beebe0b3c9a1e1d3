// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "operator/sequence.h"

namespace vps::device {
namespace {

constexpr int kLittleBackOffs = 3;   // after these back-offs the part is withdrawn to before the mouth
constexpr double kDeeper_m = 2e-3;   // distance beyond one mouth at which there may be another mouth
constexpr double kFreeWay_m = 3e-3;  // a free advance of three back-offs: the part had left the first hole
constexpr int kSearchesDeeper = 4;   // searches at one place before the part is withdrawn to the first mouth

}  // namespace

void Insertion::reset() noexcept {
  has_aligned_ = false;
  stuck_inside_ = searches_ = searches_deeper_ = 0;
  first_mouth_m_ = approach_from_m_ = 0;
}

void Insertion::prepare() noexcept {
  const OperatorHabits& habits = situation_.habits;
  situation_.push_limit_N = std::min(habits.force_limit_N, habits.press_N * (1 + 0.5 * (retries_ % 5)));
  situation_.attempt = searches_ / 2;
}

void Insertion::next(bool succeeded, const Feel& feel) noexcept {
  if (present().isSearch())
    return succeeded ? start(OperatorStrategy::AlignByTorque, feel) : backOff(true, feel);
  switch (strategy_) {
    case OperatorStrategy::Approach:
      if (!situation_.has_touched) first_mouth_m_ = feel.along_m;
      noteNextMouth(feel);
      return startTouch(feel);
    case OperatorStrategy::Touch:
      return afterTouch(feel);
    case OperatorStrategy::AlignByTorque: {
      approach_from_m_ = feel.along_m;
      const bool is_free = feel.resist_N < 0.5 * situation_.habits.touch_N;
      return start(is_free ? OperatorStrategy::Approach : OperatorStrategy::Touch, feel);
    }
    case OperatorStrategy::BackOff:
      approach_from_m_ = feel.along_m;
      return start(situation_.backs_off_whole ? nextSearch() : OperatorStrategy::AlignByTorque, feel);
    case OperatorStrategy::PressHome:
      return backOff(false, feel);
    default:
      return;
  }
}

// The operator first tries straight ahead, then each search in the order of the rows, repeatedly. A search
// that does not suit the part is replaced by the next search that does.
OperatorStrategy Insertion::nextSearch() const noexcept {
  std::array<OperatorStrategy, kStrategies> turns{};  // strategies in the reverse order of their turns
  std::size_t count = 0;
  OperatorStrategy suited = OperatorStrategy::None;
  for (std::size_t row = kStrategies - 1; row > 0; --row) {
    const auto strategy = static_cast<OperatorStrategy>(row);
    if (!of(strategy).isSearch()) continue;
    if (of(strategy).suits(situation_)) suited = strategy;
    if (suited != OperatorStrategy::None) turns[count++] = suited;
  }
  turns[count++] = OperatorStrategy::Approach;
  return turns[count - 1 - static_cast<std::size_t>(searches_) % count];
}

// A ring that has passed one land of a stepped shaft moves on freely until it meets the next land. The search
// begins at the next land, and not before the first land, which the ring would have to pass again.
void Insertion::noteNextMouth(const Feel& feel) noexcept {
  const bool went_freely = feel.along_m > approach_from_m_ + kFreeWay_m;
  if (situation_.is_slender || !went_freely || feel.along_m < situation_.mouth_m + kDeeper_m) return;
  if (!situation_.has_touched) return;
  situation_.mouth_m = feel.along_m;
  has_aligned_ = false;
  stuck_inside_ = searches_ = searches_deeper_ = 0;
}

// The part touches and slides no farther: it is at its target, in the hole, or next to the hole.
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

// A long part that has passed one wall may stand before the next wall, whose hole it has to find like the
// first one; or it is jammed in the first hole.
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
  situation_.backs_off_whole = is_whole;
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
