// SPDX-License-Identifier: BSD-3-Clause
// Judges the poses that a part went through: the deepest penetration by exact distance.
#pragma once

#include <atomic>
#include <vector>

#include "judge/overlap_judge.h"

namespace vps::scenes {

/// A pose of the moving part, with the depth of its contacts in that pose as the solver saw them.
struct OverlapSample {
  double time_s = 0;
  Pose X_WP;
  double depth_m = 0;
  /// The sample before it is of the physics step before. Otherwise nothing is known of the way between them.
  bool follows = true;
};

/// A passage between the poses of two physics steps is at most half as deep as the part moves between them,
/// so that only where it moves by more than this passages are searched for. A hand moves by less.
inline constexpr double kFast_m = 0.1e-3;

struct OverlapVerdict {
  Penetration worst;
  double time_s = 0;
  std::size_t poses_judged = 0;
  /// 0: each passage was searched to its end. Otherwise those that were not are no deeper than this.
  double unsearched_m = 0;
};

/// Judges every `stride`-th pose, the last pose, and the kSuspects poses with the deepest contacts. A pose
/// that differs from the last one judged by less than OverlapJudge::kCertain_m (greatest motion of any point)
/// is skipped. Between samples that follow each other and are more than kFast_m apart, passages that are more
/// than half of that deep are searched for (MotionJudge).
/// @param stop  ends the search early when set; the result is what was found until then; may be null
OverlapVerdict judgeSamples(const OverlapJudge& judge, const JudgedBody& moving,
                            const std::vector<OverlapSample>& samples, std::size_t stride,
                            const std::atomic<bool>* stop = nullptr);

}  // namespace vps::scenes
