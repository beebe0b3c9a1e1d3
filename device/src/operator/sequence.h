// SPDX-License-Identifier: BSD-3-Clause
// The order in which strategies are tried, for one kind of motion.
#pragma once

#include "operator/strategies.h"

namespace vps::device::inline v0 {

class Sequence {
 public:
  virtual ~Sequence() = default;
  virtual void begin(const Situation& situation, const Feel& feel) noexcept = 0;
  /// Done when the part is home. Never fails by itself: the operator gives up at its timeout.
  virtual Outcome step(const Feel& feel, double dt_s) noexcept = 0;

  [[nodiscard]] OperatorStrategy strategy() const noexcept { return strategy_; }
  [[nodiscard]] const Move& move() const noexcept { return present().move(); }
  [[nodiscard]] int retries() const noexcept { return retries_; }

 protected:
  [[nodiscard]] virtual const Strategy& present() const noexcept = 0;

  OperatorStrategy strategy_ = OperatorStrategy::None;
  int retries_ = 0;
};

}  // namespace vps::device::inline v0
