// SPDX-License-Identifier: BSD-3-Clause
// The poses a part went through, and how deep it was by exact distance.
#pragma once

#include <atomic>
#include <vector>

#include "judge/overlap_judge.h"

namespace vps::scenes {

/// A pose of the part that moves, and how deep its contacts were in that pose as the solver saw them.
struct OverlapSample {
  double time_s = 0;
  Pose X_WP;
  double depth_m = 0;
};

struct OverlapVerdict {
  Penetration worst;
  double time_s = 0;
  std::size_t poses_judged = 0;
};

/// Judges every `stride`-th pose, the last, and, whatever the stride, the kSuspects poses whose contacts were
/// deepest. A pose within OverlapJudge::kCertain_m of the last one judged (greatest motion of any point) is
/// that one.
/// @param stop  ends it early when set, with what was found by then; may be null
OverlapVerdict judge(const OverlapJudge& fit, const JudgedBody& moving,
                     const std::vector<OverlapSample>& samples, std::size_t stride,
                     const std::atomic<bool>* stop = nullptr);

}  // namespace vps::scenes
