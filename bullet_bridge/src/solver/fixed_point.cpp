// SPDX-License-Identifier: BSD-3-Clause
#include "solver/fixed_point.h"

#include <algorithm>

namespace vps::bullet::inline v0 {

Eigen::VectorXd FixedPoint::next(const Eigen::VectorXd& x, const Eigen::VectorXd& fx) {
  const Eigen::VectorXd change = fx - x;
  Eigen::VectorXd next = fx;
  if (pairs_ == 0) {
    changes_.resize(x.size(), kHistory);
    steps_.resize(x.size(), kHistory);
  } else {
    const int columns = std::min(pairs_, kHistory), last = (pairs_ - 1) % kHistory;
    changes_.col(last) = change - last_change_;
    steps_.col(last) = fx - last_fx_;
    const Eigen::MatrixXd differences = changes_.leftCols(columns);
    const Eigen::VectorXd weights = differences.colPivHouseholderQr().solve(change);
    if (weights.allFinite()) next -= steps_.leftCols(columns) * weights;
  }
  last_change_ = change;
  last_fx_ = fx;
  ++pairs_;
  return next;
}

}  // namespace vps::bullet::inline v0
