// SPDX-License-Identifier: BSD-3-Clause
// Training: a trainee's recorded run against an expert's, step by step.
#pragma once

#include <string>
#include <vector>

#include "vps/pose.h"
#include "vps_device/recording.h"
#include "vps_scenes/export.h"

namespace vps::scenes {

/// One sample of a step while the part is in hand.
struct HandSample {
  double time_s = 0;  ///< since the step began
  Pose X_WG;          ///< of the part, at its centre of mass
  double force_N = 0;
};

/// What one run did in a step, until the part was let go.
struct RunMeasures {
  double duration_s = 0;
  double path_m = 0;        ///< way of the part's centre of mass, in pieces of kPathPiece_m
  double peak_force_N = 0;  ///< on the hand
  double mean_force_N = 0;  ///< over time
};

/// Shorter motions are the encoders' resolution, or a tremor, and count as none.
inline constexpr double kPathPiece_m = 0.5e-3;

struct ComparedStep {
  std::string part;
  bool is_done = false;  ///< the trainee brought the part to its target
  RunMeasures expert, trainee;
  double detour_m = 0;     ///< the trainee's path less the expert's
  double deviation_m = 0;  ///< greatest distance of the trainee's path from the expert's
  double mean_deviation_m = 0;
  double deviation_rad = 0;   ///< greatest rotation against the nearest pose of the expert's path
  double excess_force_N = 0;  ///< the trainee's peak force less the expert's
  /// 0 to 100: the mean of three shares, each the expert's value by the trainee's and at most 1, of time,
  /// path and peak force; 0 for a step that is not done. assumed: equal weights
  double score = 0;
  std::vector<HandSample> expert_samples, trainee_samples;  ///< for pictures
};

/// A lesser force is as good as none, so that a share of forces means something. assumed: what a hand feels
/// well
inline constexpr double kLeastForce_N = 1;

struct RunComparison {
  std::string expert, trainee;      ///< files
  double score = 0;                 ///< mean over the expert's steps
  std::vector<ComparedStep> steps;  ///< in the expert's order
  std::vector<std::string> notes;   ///< what makes the comparison doubtful, in words
};

/// Steps are matched by the names of their parts. O(n m) for n and m samples of a step. Throws LoadError
/// where a recording holds no scene or no trace, and where the two have no part in common.
VPS_SCENES_API RunComparison compareRuns(const device::RecordedRun& expert,
                                         const device::RecordedRun& trainee);

}  // namespace vps::scenes
