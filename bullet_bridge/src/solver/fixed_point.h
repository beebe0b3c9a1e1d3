// SPDX-License-Identifier: BSD-3-Clause
// A fixed point x = f(x), from pairs of x and f(x).
#pragma once

#include <Eigen/Dense>

namespace vps::bullet::inline v0 {

/// Anderson's extrapolation: the combination of the last pairs whose changes f(x) - x cancel best. Where x,
/// f(x), f(f(x)), ... approaches the fixed point by a constant factor only, this needs about as many pairs as
/// there are slow directions.
///
/// Source: Anderson 1965; Walker and Ni 2011, in its form without restarts.
class FixedPoint {
 public:
  /// Forgets all pairs.
  void clear() { pairs_ = 0; }
  /// Adds a pair and returns the next x to try. All pairs until clear() have one size.
  [[nodiscard]] Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& fx);

 private:
  static constexpr int kHistory = 5;  // assumed: the differences that it looks back to
  int pairs_ = 0;
  Eigen::VectorXd last_change_, last_fx_;
  Eigen::MatrixXd changes_, steps_;  // differences of changes and of f(x), from pair to pair
};

}  // namespace vps::bullet::inline v0
