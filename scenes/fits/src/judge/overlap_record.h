// SPDX-License-Identifier: BSD-3-Clause
// Judges the recorded poses of a part: the deepest penetration by exact distance.
#pragma once

#include <atomic>
#include <vector>

#include "judge/overlap_judge.h"

namespace vps::scenes {

/// A pose of the moving part, with the depth of its contacts in that pose as the solver received them.
struct OverlapSample {
  double time_s = 0;
  Pose X_WP;
  double depth_m = 0;
  /// True if the previous sample is from the previous physics step. If false, the path between the two
  /// samples is unknown.
  bool follows = true;
};

/// Motion within a physics step above which overlaps between the poses of the step are searched for. An
/// overlap between two poses is at most half as deep as the part's motion within the step. A hand moves by
/// less than this limit in a step.
inline constexpr double kFast_m = 0.1e-3;

/// The deepest penetration of a run.
struct OverlapVerdict {
  Penetration worst;
  double time_s = 0;
  std::size_t poses_judged = 0;
  /// 0 if each search between two samples ran to its end. Else an upper bound of the depth that searches with
  /// an early end may have missed.
  double unsearched_m = 0;
};

/// Judges every `stride`-th pose, the last pose, and the kSuspects poses with the deepest contacts. A pose is
/// skipped if no point of it differs by OverlapJudge::kCertain_m or more from the pose that was judged
/// before. Between consecutive samples that are more than kFast_m apart, MotionJudge searches for overlaps
/// deeper than kFast_m / 2.
/// @param stop ends the judgement early when set, with the result so far; may be null
OverlapVerdict judgeSamples(const OverlapJudge& judge, const JudgedBody& moving,
                            const std::vector<OverlapSample>& samples, std::size_t stride,
                            const std::atomic<bool>* stop = nullptr);

}  // namespace vps::scenes
