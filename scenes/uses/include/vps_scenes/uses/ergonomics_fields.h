// SPDX-License-Identifier: BSD-3-Clause
// The numbers of ergonomics as JSON shows them.
#pragma once

#include "vps_scenes/scene/fields.h"
#include "vps_scenes/uses/ergonomics.h"

namespace vps::scenes {

inline constexpr auto kStepErgonomicsFields = std::make_tuple(
    field("part", &StepErgonomics::part, "part of the step"),
    field("body", &StepErgonomics::body, "`small woman` or `large man` (assumed sizes)"),
    field("posture", &StepErgonomics::posture, "`seated` or `standing`"),
    field("hand", &StepErgonomics::hand, "`left` or `right`: that with less strain"),
    field("greatest_reach", &StepErgonomics::greatest_reach,
          "greatest distance of the hand from the shoulder, as a share of the arm's length"),
    field("out_of_reach_share", &StepErgonomics::out_of_reach_share,
          "share of the time in hand with the part out of reach"),
    field("raised_rad", &StepErgonomics::raised_rad, "greatest angle of the upper arm from hanging down"),
    field("elbow_least_rad", &StepErgonomics::elbow_least_rad, "least flexion of the elbow; 0: stretched"),
    field("elbow_most_rad", &StepErgonomics::elbow_most_rad, "greatest flexion of the elbow"),
    field("rula_mean", &StepErgonomics::rula_mean,
          "mean over time of RULA's scores of upper and lower arm, 2 (best) to 6"),
    field("rula_worst", &StepErgonomics::rula_worst, "the greatest of them"));
static_assert(coversAllMembers<StepErgonomics>(kStepErgonomicsFields));

}  // namespace vps::scenes
