// SPDX-License-Identifier: BSD-3-Clause
// Field tables of a study, for JSON and the lines of its log.
#pragma once

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
                          "the virtual hand made the runs; false: geometry alone judged them"),
                    field("good", &StudyResult::good, "runs that fit"),
                    field("blocked", &StudyResult::blocked, "runs that geometry rules out"),
                    field("yield", &StudyResult::yield, "share of the runs that fit"),
                    field("yield_low", &StudyResult::yield_low, "lower end of Wilson's 95 % interval"),
                    field("upper end of Wilson's 95 % interval", &StudyResult::yield_high, "upper end"),
                    list("effects", &StudyResult::effects, kStudyEffectFields),
                    list("runs", &StudyResult::runs, kStudyRunFields));

}  // namespace vps::scenes
