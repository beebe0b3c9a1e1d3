// SPDX-License-Identifier: BSD-3-Clause
// The numbers of a comparison as JSON shows them.
#pragma once

#include "vps_scenes/scene/fields.h"
#include "vps_scenes/uses/compare.h"

namespace vps::scenes {

inline constexpr auto kRunMeasureFields = std::make_tuple(
    field("duration_s", &RunMeasures::duration_s, "from taking the part to letting it go, simulated time"),
    field("path_m", &RunMeasures::path_m, "way of the part's centre of mass"),
    field("peak_force_N", &RunMeasures::peak_force_N, "greatest force on the hand"),
    field("mean_force_N", &RunMeasures::mean_force_N, "its mean over time"));
static_assert(coversAllMembers<RunMeasures>(kRunMeasureFields));

inline constexpr auto kComparedStepFields = std::make_tuple(
    field("part", &ComparedStep::part, "part of the step"),
    field("done", &ComparedStep::is_done, "the trainee brought it to its target"),
    field("score", &ComparedStep::score,
          "0 to 100: mean of the shares of time, path and peak force, each the expert's by the trainee's and "
          "at most 1; forces below 1 N count as 1 N; 0: not done"),
    field("detour_m", &ComparedStep::detour_m, "the trainee's path less the expert's"),
    field("deviation_m", &ComparedStep::deviation_m,
          "greatest distance of the trainee's path from the expert's"),
    field("mean_deviation_m", &ComparedStep::mean_deviation_m, "mean of that distance along the path"),
    field("deviation_rad", &ComparedStep::deviation_rad,
          "greatest rotation against the nearest pose of the expert's path"),
    field("excess_force_N", &ComparedStep::excess_force_N, "the trainee's peak force less the expert's"),
    group("expert", &ComparedStep::expert, kRunMeasureFields, "of the expert's run"),
    group("trainee", &ComparedStep::trainee, kRunMeasureFields, "of the trainee's run"));

inline constexpr auto kComparisonFields =
    std::make_tuple(field("expert", &RunComparison::expert, "file of the expert's recording"),
                    field("trainee", &RunComparison::trainee, "file of the trainee's"),
                    field("score", &RunComparison::score, "mean over the steps of the expert's run"),
                    field("notes", &RunComparison::notes, "what makes the comparison doubtful"),
                    list("steps", &RunComparison::steps, kComparedStepFields));
static_assert(coversAllMembers<RunComparison>(kComparisonFields));

}  // namespace vps::scenes
