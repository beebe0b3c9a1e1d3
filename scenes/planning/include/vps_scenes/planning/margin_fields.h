// SPDX-License-Identifier: BSD-3-Clause
// Field tables of margins, for JSON and CSV.
#pragma once

#include "vps_scenes/planning/margin.h"
#include "vps_scenes/scene/fields.h"

namespace vps::scenes {

inline constexpr auto kStepMarginFields = std::make_tuple(
    field("step", &StepMargin::step, "index in the procedure"),
    field("part", &StepMargin::part, "part of the step"),
    field("goes", &StepMargin::goes, "the step succeeds with the part as drawn"),
    field("growth_m", &StepMargin::growth_m,
          "greatest outward offset of all faces of the part with which the step succeeds; half of the growth "
          "in diameter"),
    field("growth_fails_m", &StepMargin::growth_fails_m,
          "least offset with which the step fails; null: it succeeds with all offsets that were tried"),
    field("fails_as", &StepMargin::fails_as,
          "verdict with `growth_fails_m`: `blocked` (by geometry) or `not_shown`; `fits`: no offset failed"),
    field("fails_why", &StepMargin::fails_why, "reason of the verdict `fails_as`"),
    field("growth_bound_m", &StepMargin::growth_bound_m, "greatest offset that geometry alone allows"),
    field("position_m", &StepMargin::position_m,
          "least displacement along an axis of its play across the path that makes the part touch at its "
          "target; "
          "null: no displacement does"),
    field("position_axis", &StepMargin::position_W,
          "direction of the displacement `position_m`, in the world"),
    field("position_error_m", &StepMargin::position_error_m, "bound of the error of `position_m`"),
    field("angle_rad", &StepMargin::angle_rad,
          "least rotation about an axis across the path that makes the part touch; null: no rotation does"),
    field("angle_error_rad", &StepMargin::angle_error_rad, "bound of the error of `angle_rad`"),
    field("checks", &StepMargin::checks, "number of exact measurements"),
    field("runs", &StepMargin::runs, "number of runs of the virtual hand"));

}  // namespace vps::scenes
