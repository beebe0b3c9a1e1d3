// SPDX-License-Identifier: BSD-3-Clause
// The order in which strategies are tried: one Sequence for insertion, and one for screwing.
#pragma once

#include <array>

#include "operator/strategies/strategy.h"

namespace vps::device {

/// Counts each row of VPS_OPERATOR_STRATEGIES, and OperatorStrategy::None.
#define VPS_COUNT(Name, name) +1
inline constexpr std::size_t kStrategies = 1 VPS_OPERATOR_STRATEGIES(VPS_COUNT);
#undef VPS_COUNT
static_assert(kStrategies <= 16, "a recording keeps the strategy in four bits: OperatorState");

/// Every sequence begins with Approach and Touch. A part that nothing stops is placed by sight.
class Sequence {
 public:
  Sequence();
  virtual ~Sequence() = default;
  /// Starts a search of a task; one task may have several searches.
  void begin(const Situation& situation, const Feel& feel) noexcept;
  /// To be called before a new task: retries() then counts from 0.
  void forgetRetries() noexcept { retries_ = earlier_retries_ = 0; }
  /// Returns Done when the part is at its target. Never returns Failed: the operator gives up at its timeout.
  Outcome step(const Feel& feel, double dt_s) noexcept;

  [[nodiscard]] OperatorStrategy strategy() const noexcept { return strategy_; }
  /// Whether the part is at its target when the strategy in use succeeds.
  [[nodiscard]] bool isAtLastStrategy() const noexcept {
    return strategy_ == OperatorStrategy::PressHome || strategy_ == OperatorStrategy::ScrewOn ||
           strategy_ == OperatorStrategy::PlaceBySight;
  }
  /// The strategy in use. Not to be called before the first begin().
  [[nodiscard]] const Strategy& present() const noexcept { return of(strategy_); }
  /// Number of retries in all searches of the task.
  [[nodiscard]] int retries() const noexcept { return earlier_retries_ + retries_; }

 protected:
  [[nodiscard]] Strategy& of(OperatorStrategy strategy) const noexcept {
    return *strategies_[static_cast<std::size_t>(strategy)];
  }
  void start(OperatorStrategy strategy, const Feel& feel) noexcept;
  /// Starts Touch after an Approach that ended with contact.
  void startTouch(const Feel& feel) noexcept;

  /// Clears the state of an earlier search.
  virtual void reset() noexcept = 0;
  /// Sets what the next strategy may use in situation_.
  virtual void prepare() noexcept = 0;
  /// Starts the strategy that follows strategy_, which has succeeded or failed.
  virtual void next(bool succeeded, const Feel& feel) noexcept = 0;

  Situation situation_;
  OperatorStrategy strategy_ = OperatorStrategy::None;
  int retries_ = 0;  ///< retries of this search

 private:
  std::array<std::unique_ptr<Strategy>, kStrategies> strategies_;
  int earlier_retries_ = 0;
};

///   approach -> touch -> seen near the target?    -> press home -> done
///                 |  \-> in the hole already?     -> align by torque -> touch
///                 |  \-> free as far as the next land of a stepped shaft: the search begins anew there
///                 |  \-> a slender part, perhaps at the mouth of a second hole -> spiral search there
///                 \----> align, then each search that suits the part in turn, after backing off
class Insertion final : public Sequence {
 public:
  [[nodiscard]] bool hasTouched() const noexcept { return situation_.has_touched; }
  /// `along_m` where the part first touched: the mouth of its hole.
  [[nodiscard]] double firstMouth_m() const noexcept { return first_mouth_m_; }

 private:
  void reset() noexcept override;
  void prepare() noexcept override;
  void next(bool succeeded, const Feel& feel) noexcept override;
  [[nodiscard]] OperatorStrategy nextSearch() const noexcept;
  void noteNextMouth(const Feel& feel) noexcept;
  void afterTouch(const Feel& feel) noexcept;
  void afterTouchInside(const Feel& feel) noexcept;
  void backOff(bool is_whole, const Feel& feel) noexcept;

  bool has_aligned_ = false;
  int stuck_inside_ = 0, searches_ = 0, searches_deeper_ = 0;
  double first_mouth_m_ = 0, approach_from_m_ = 0;
};

///   approach -> touch -> turn back until it drops -> screw on -> done
///      ^                                                |
///      '-- back off, and look again <- turn back <------'  the part does not follow the thread
class Screwing final : public Sequence {
 private:
  void reset() noexcept override { is_coming_off_ = false; }
  void prepare() noexcept override;
  void next(bool succeeded, const Feel& feel) noexcept override;

  bool is_coming_off_ = false;
  double screwed_from_rad_ = 0,
         screwed_rad_ = 0;  ///< angles of the last ScrewOn: its start, and its rotation
};

}  // namespace vps::device
