// SPDX-License-Identifier: BSD-3-Clause
// The poses a part went through, and how deep it was by exact distance.
#pragma once

#include <vector>

#include "exact_fit.h"

namespace vps {

/// One physics step of the part that moves.
struct FitSample {
  double time_s = 0;
  Pose X_WP;
  double depth_m = 0;  ///< by the contacts the solver saw
};

struct FitVerdict {
  Penetration worst;
  double time_s = 0;
  std::size_t poses_judged = 0;
};

/// Judges every `stride`-th pose and, whatever the stride, the kSuspects poses whose contacts were deepest.
/// O(poses / stride) exact checks; parallel within a check.
FitVerdict judge(const ExactFit& fit, const FitBody& moving, const std::vector<FitSample>& samples,
                 std::size_t stride);

}  // namespace vps
