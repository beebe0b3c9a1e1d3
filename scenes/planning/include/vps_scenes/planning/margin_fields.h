// SPDX-License-Identifier: BSD-3-Clause
// The numbers of margins as JSON and CSV show them.
#pragma once

#include "vps_scenes/planning/margin.h"
#include "vps_scenes/scene/fields.h"

namespace vps::scenes {

inline constexpr auto kStepMarginFields = std::make_tuple(
    field("step", &StepMargin::step, "index in the procedure"),
    field("part", &StepMargin::part, "part of the step"),
    field("goes", &StepMargin::goes, "it goes as drawn"),
    field("growth_m", &StepMargin::growth_m,
          "greatest outward offset of all its faces with which it goes; half of the growth in diameter"),
    field("growth_fails_m", &StepMargin::growth_fails_m,
          "least offset with which it does not; null: it goes with all that were looked at"),
    field("fails_as", &StepMargin::fails_as,
          "verdict with that offset: `blocked` (by geometry) or `not_shown`; `fits`: it does not fail"),
    field("fails_why", &StepMargin::fails_why, "reason of that verdict"),
    field("growth_bound_m", &StepMargin::growth_bound_m, "greatest offset that geometry alone allows"),
    field("position_m", &StepMargin::position_m,
          "least displacement along an axis of its play across the path that makes it touch at its target; "
          "null: none does"),
    field("position_axis", &StepMargin::position_W, "its direction, in the world"),
    field("position_error_m", &StepMargin::position_error_m, "bound of its error"),
    field("angle_rad", &StepMargin::angle_rad,
          "least rotation about an axis across the path that makes it touch; null: none does"),
    field("angle_error_rad", &StepMargin::angle_error_rad, "bound of its error"),
    field("checks", &StepMargin::checks, "exact measurements that it took"),
    field("runs", &StepMargin::runs, "runs of the hand that it took"));

}  // namespace vps::scenes
