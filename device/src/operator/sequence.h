// SPDX-License-Identifier: BSD-3-Clause
// The order in which strategies are tried, for one kind of motion. Each begins with approach and touch and
// may end with a part that is placed by sight.
#pragma once

#include "operator/strategies/strategies.h"

namespace vps::device {

class Sequence {
 public:
  virtual ~Sequence() = default;
  /// A search of a task; one task may have several.
  void begin(const Situation& situation, const Feel& feel) noexcept;
  /// Before a new task: retries() counts from 0.
  void forgetRetries() noexcept { retries_ = earlier_retries_ = 0; }
  /// Done when the part is home. Never fails by itself: the operator gives up at its timeout.
  Outcome step(const Feel& feel, double dt_s) noexcept;

  [[nodiscard]] OperatorStrategy strategy() const noexcept { return strategy_; }
  [[nodiscard]] const Move& move() const noexcept {
    return const_cast<Sequence*>(this)->present().move();  // NOLINT
  }
  /// Of all searches of the task.
  [[nodiscard]] int retries() const noexcept { return earlier_retries_ + retries_; }

 protected:
  void start(OperatorStrategy strategy, const Feel& feel) noexcept;
  /// What follows the approach.
  void afterApproach(bool has_touched, const Feel& feel) noexcept;

  /// Forgets what earlier parts left.
  virtual void reset() noexcept = 0;
  /// Sets what the next strategy may use in situation_.
  virtual void prepare() noexcept = 0;
  /// That of strategy(); of the base class, where it is one of its own.
  [[nodiscard]] virtual Strategy& present() noexcept;
  virtual void next(bool succeeded, const Feel& feel) noexcept = 0;

  Situation situation_;
  OperatorStrategy strategy_ = OperatorStrategy::None;
  int retries_ = 0;  ///< of this search

 private:
  int earlier_retries_ = 0;
  Approach approach_;
  Touch touch_;
  PlaceBySight place_by_sight_;
};

}  // namespace vps::device
