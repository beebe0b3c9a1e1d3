// SPDX-License-Identifier: BSD-3-Clause
// The greatest least gap of some gaps that are linear in a motion.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace vps::scenes {

/// A gap that is linear in six numbers x, each between -1 and 1: at_zero_m + slope_m . x.
struct LinearGap {
  double at_zero_m = 0;
  Eigen::Matrix<double, 6, 1> slope_m = Eigen::Matrix<double, 6, 1>::Zero();
};

/// The greatest value, over all x, of the least gap, as an upper bound with its proof.
struct GreatestGap {
  /// Upper bound: the weighted mean of the gaps at zero plus the sum of the absolute values of the weighted
  /// mean of the slopes. For the optimal weights it is the greatest least gap (duality of linear
  /// programming).
  double most_m = 0;
  std::vector<double> weight;  ///< by gap: at least 0, with sum 1; at most seven are not 0
};

/// Solves the linear program of the weights by the simplex method. If rounding or the limit of steps ends it
/// early, the bound holds all the same, but is not the least. O(steps x gaps), with about as many steps as
/// gaps have weights. At least one gap is needed.
GreatestGap greatestLeastGap(std::span<const LinearGap> gaps);

}  // namespace vps::scenes
