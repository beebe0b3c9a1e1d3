// SPDX-License-Identifier: BSD-3-Clause
// Sums a part's rotation about z over more than a turn.
#pragma once

#include <cmath>
#include <numbers>

#include "world.h"

namespace vps::dynamics {

/// Call update() at least every half turn.
class TurnCounter {
 public:
  explicit TurnCounter(const Placed& placed) : placed_(placed), last_rad_(now()) {}
  /// @return the rotation since construction [rad], counter-clockwise positive
  double update() {
    const double at_rad = now();
    sum_rad_ += std::remainder(at_rad - last_rad_, 2 * std::numbers::pi);
    last_rad_ = at_rad;
    return sum_rad_;
  }

 private:
  [[nodiscard]] double now() const {
    const Mat3 R = placed_.pose().R;
    return std::atan2(R(1, 0), R(0, 0));
  }
  Placed placed_;
  double last_rad_, sum_rad_ = 0;
};

}  // namespace vps::dynamics
