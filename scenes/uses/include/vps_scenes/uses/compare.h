// SPDX-License-Identifier: BSD-3-Clause
// Training: a trainee's recorded run against an expert's, step by step.
#pragma once

#include <string>
#include <vector>

#include "vps/pose.h"
#include "vps_device/recording.h"
#include "vps_scenes/export.h"
#include "vps_scenes/scene/fields.h"

namespace vps::scenes {

/// One sample of a step while the part is in hand.
struct HandSample {
  double time_s = 0;  ///< time since the part was taken
  Pose X_WG;          ///< pose of the part, at its centre of mass
  double force_N = 0;
};

/// Measures of one run in one step, from taking the part until releasing it.
struct RunMeasures {
  double duration_s = 0;
  double path_m = 0;        ///< length of the path of the part's centre of mass, in pieces of kPathPiece_m
  double peak_force_N = 0;  ///< greatest force on the hand
  double mean_force_N = 0;  ///< mean force on the hand, over time
};

/// Motions shorter than this length do not count as path, since such motions are within the encoders'
/// resolution or the hand's tremor.
inline constexpr double kPathPiece_m = 0.5e-3;

/// One step of the trainee's run compared with the same step of the expert's run.
struct ComparedStep {
  std::string part;
  bool is_done = false;  ///< the trainee brought the part to its target
  RunMeasures expert, trainee;
  double detour_m = 0;     ///< length of the trainee's path minus the expert's
  double deviation_m = 0;  ///< greatest distance of the trainee's path from the expert's
  double mean_deviation_m = 0;
  double deviation_rad = 0;   ///< greatest rotation against the nearest pose of the expert's path
  double excess_force_N = 0;  ///< the trainee's peak force minus the expert's
  /// Score from 0 to 100: the mean of three ratios, for time, path and peak force. Each ratio of the score is
  /// the expert's value divided by the trainee's and at most 1. The score of a step that is not done is 0.
  /// assumed: the ratios have equal weights
  double score = 0;
  std::vector<HandSample> expert_samples, trainee_samples;  ///< for the report's plots of path and force
};

/// A force below kLeastForce_N counts as kLeastForce_N, so that the ratio of two small forces does not
/// dominate a score. assumed: a force that a hand feels clearly
inline constexpr double kLeastForce_N = 1;

struct RunComparison {
  std::string expert, trainee;      ///< file names of the recordings
  double score = 0;                 ///< mean score of the expert's steps
  std::vector<ComparedStep> steps;  ///< in the order of the expert's run
  std::vector<std::string> notes;   ///< reasons to doubt the comparison, in words
};

/// Compares two recordings step by step; steps are matched by the names of their parts. O(n m) for n and m
/// samples of a step. Throws LoadError if a recording holds no scene or no trace, or if the two recordings
/// have no part in common.
VPS_SCENES_API RunComparison compareRuns(const device::RecordedRun& expert,
                                         const device::RecordedRun& trainee);

inline constexpr auto kRunMeasureFields = std::make_tuple(
    field("duration_s", &RunMeasures::duration_s, "simulated time from taking the part to releasing it"),
    field("path_m", &RunMeasures::path_m, "length of the path of the part's centre of mass"),
    field("peak_force_N", &RunMeasures::peak_force_N, "greatest force on the hand"),
    field("mean_force_N", &RunMeasures::mean_force_N, "mean force on the hand over time"));
static_assert(coversAllMembers<RunMeasures>(kRunMeasureFields));

inline constexpr auto kComparedStepFields = std::make_tuple(
    field("part", &ComparedStep::part, "part of the step"),
    field("done", &ComparedStep::is_done, "whether the trainee brought the part to its target"),
    field("score", &ComparedStep::score,
          "score from 0 to 100: the mean of the ratios of time, path and peak force, each the expert's value "
          "divided by the trainee's and at most 1; forces below 1 N count as 1 N; 0: the step is not done"),
    field("detour_m", &ComparedStep::detour_m, "length of the trainee's path minus the expert's"),
    field("deviation_m", &ComparedStep::deviation_m,
          "greatest distance of the trainee's path from the expert's path"),
    field("mean_deviation_m", &ComparedStep::mean_deviation_m,
          "mean distance along the trainee's path from the expert's path"),
    field("deviation_rad", &ComparedStep::deviation_rad,
          "greatest rotation against the nearest pose of the expert's path"),
    field("excess_force_N", &ComparedStep::excess_force_N, "the trainee's peak force minus the expert's"),
    group("expert", &ComparedStep::expert, kRunMeasureFields, "measures of the expert's run"),
    group("trainee", &ComparedStep::trainee, kRunMeasureFields, "measures of the trainee's run"));

inline constexpr auto kComparisonFields =
    std::make_tuple(field("expert", &RunComparison::expert, "file of the expert's recording"),
                    field("trainee", &RunComparison::trainee, "file of the trainee's recording"),
                    field("score", &RunComparison::score, "mean score over the steps of the expert's run"),
                    field("notes", &RunComparison::notes, "reasons to doubt the comparison"),
                    list("steps", &RunComparison::steps, kComparedStepFields));
static_assert(coversAllMembers<RunComparison>(kComparisonFields));

}  // namespace vps::scenes
