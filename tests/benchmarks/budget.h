// SPDX-License-Identifier: BSD-3-Clause
// How the error of the wrench falls as a query's budget grows.
#pragma once

#include <vector>

#include "scene.h"

namespace vps::bench {

/// Over the poses of a motion, against queryWrench() at the same pose.
struct BudgetPoint {
  std::size_t max_points = 0;
  double points = 0;      ///< read, mean
  double force_rms = 0;   ///< of the difference, as part of the rms force
  double force_most = 0;  ///< greatest difference, as part of the rms force
  double torque_rms = 0;  ///< as force_rms
  double bound_rms = 0;   ///< of the error bound that the report gives, as part of the rms force
  double complete = 0;    ///< part of the poses
  double median_us = 0;
};

/// One line for each of `budgets`; the wrench is about the shell's origin. The last line is queryWrench()'s
/// own.
std::vector<BudgetPoint> budgetStudy(const scenes::Scene& scene, const Motion& motion, int poses,
                                     const std::vector<std::size_t>& budgets);

}  // namespace vps::bench
