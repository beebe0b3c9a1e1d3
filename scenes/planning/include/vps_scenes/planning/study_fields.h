// SPDX-License-Identifier: BSD-3-Clause
// Field tables of studies and margins, for JSON, CSV and the lines of a study's log.
#pragma once

#include "vps_scenes/planning/margin.h"
#include "vps_scenes/planning/study.h"
#include "vps_scenes/scene/fields.h"

namespace vps::scenes {

inline constexpr auto kStudyRunFields = std::make_tuple(
    field("run", &StudyRun::run, "number of the run"), field("verdict", &StudyRun::verdict, "verdict"),
    field("part", &StudyRun::part, "part of the first step that does not fit; empty: all fit"),
    field("reason", &StudyRun::reason, "why the step does not fit"),
    field("simulated_s", &StudyRun::simulated_s, "simulated time; 0: the virtual hand was not needed"),
    field("values", &StudyRun::values, "deviation of each variable, in the order of the log's `variables`"));

inline constexpr auto kStudyEffectFields = std::make_tuple(
    field("name", path(&StudyEffect::variable, &StudyVariable::name), "the part and its varying quantity"),
    field("index", &StudyEffect::index, "index into `runs[].values`"),
    field("distribution", path(&StudyEffect::variable, &StudyVariable::distribution),
          "`normal` or `uniform`"),
    field("lower", path(&StudyEffect::variable, &StudyVariable::lower),
          "lower limit of the deviation from the drawn value, in metres, radians or 1"),
    field("upper", path(&StudyEffect::variable, &StudyVariable::upper), "upper limit of the deviation"),
    field("yield_if_halved", &StudyEffect::yield_if_halved, "yield if this tolerance is halved"),
    field("gain", &StudyEffect::gain, "`yield_if_halved` minus `yield`"),
    field("gain_error", &StudyEffect::gain_error, "half width of the 95 % interval of `gain`"));

inline constexpr auto kStudyFields =
    std::make_tuple(field("scene", &StudyResult::scene, "name of the scene"),
                    field("seed", path(&StudyResult::settings, &StudySettings::seed), "seed of the study"),
                    field("by_contact", path(&StudyResult::settings, &StudySettings::has_contact),
                          "the virtual hand made the runs; false: geometry alone judged the runs"),
                    field("verdict", &StudyResult::verdict,
                          "`fits`: at least one run fits; `blocked`: all runs are blocked; `not_shown`: no "
                          "run fits, and some are not proven to be blocked"),
                    field("good", &StudyResult::good, "runs that fit"),
                    field("blocked", &StudyResult::blocked, "runs that are proven by geometry to be blocked"),
                    field("yield", &StudyResult::yield, "share of the runs that fit"),
                    field("yield_low", &StudyResult::yield_low, "lower end of Wilson's 95 % interval"),
                    field("yield_high", &StudyResult::yield_high, "upper end of Wilson's 95 % interval"),
                    list("effects", &StudyResult::effects, kStudyEffectFields),
                    list("runs", &StudyResult::runs, kStudyRunFields));

inline constexpr auto kStepMarginFields = std::make_tuple(
    field("step", &StepMargin::step, "index in the procedure"),
    field("part", &StepMargin::part, "part of the step"),
    field("goes", &StepMargin::goes, "the step succeeds with the part as drawn"),
    field("growth_m", &StepMargin::growth_m,
          "greatest outward offset of all faces of the part with which the step succeeds; half of the growth "
          "in diameter"),
    field("growth_fails_m", &StepMargin::growth_fails_m,
          "least offset with which the step fails; null: the step succeeds with all offsets that were tried"),
    field("fails_as", &StepMargin::fails_as,
          "verdict of the step at the offset `growth_fails_m`: `blocked`: geometry rules the step out; "
          "`not_shown`: the virtual hand failed, but geometry does not rule the step out; `fits`: no offset "
          "failed"),
    field("fails_why", &StepMargin::fails_why, "reason of the verdict `fails_as`"),
    field("growth_bound_m", &StepMargin::growth_bound_m, "greatest offset that geometry alone allows"),
    field("position_m", &StepMargin::position_m,
          "least displacement across the path, along an axis of the part's play, at which the part touches "
          "another part at its target; null: no displacement makes the part touch"),
    field("position_axis", &StepMargin::position_W,
          "direction of the displacement `position_m`, in the world"),
    field("position_error_m", &StepMargin::position_error_m, "bound of the error of `position_m`"),
    field("angle_rad", &StepMargin::angle_rad,
          "least rotation about an axis across the path that makes the part touch; null: no rotation makes "
          "the part touch"),
    field("angle_error_rad", &StepMargin::angle_error_rad, "bound of the error of `angle_rad`"),
    field("checks", &StepMargin::checks, "number of exact measurements"),
    field("runs", &StepMargin::runs, "number of runs of the virtual hand"));

}  // namespace vps::scenes
