// SPDX-License-Identifier: BSD-3-Clause
// The numbers of a study as JSON shows them, and the lines of its log.
#pragma once

#include "vps_scenes/planning/study.h"
#include "vps_scenes/scene/fields.h"

namespace vps::scenes {

inline constexpr auto kStudyRunFields = std::make_tuple(
    field("run", &StudyRun::run, "number of the run"), field("verdict", &StudyRun::verdict, "verdict"),
    field("part", &StudyRun::part, "of the first step that does not fit; empty: all fit"),
    field("reason", &StudyRun::reason, "why it does not"),
    field("simulated_s", &StudyRun::simulated_s, "simulated time; 0: the hand was not needed"),
    field("values", &StudyRun::values, "deviation in each variable, in the order of the log's `variables`"));

inline constexpr auto kStudyEffectFields = std::make_tuple(
    field("name", path(&StudyEffect::variable, &StudyVariable::name), "part and what of it varies"),
    field("index", &StudyEffect::index, "of `runs[].values`"),
    field("distribution", path(&StudyEffect::variable, &StudyVariable::distribution),
          "`normal` or `uniform`"),
    field("lower", path(&StudyEffect::variable, &StudyVariable::lower),
          "least deviation from what is drawn, in metres, radians or 1"),
    field("upper", path(&StudyEffect::variable, &StudyVariable::upper), "greatest deviation"),
    field("yield_if_halved", &StudyEffect::yield_if_halved, "yield with half of this tolerance"),
    field("gain", &StudyEffect::gain, "that less the yield"),
    field("gain_error", &StudyEffect::gain_error, "half of its interval of 95 %"));

inline constexpr auto kStudyFields =
    std::make_tuple(field("scene", &StudyResult::scene, "name of the scene"),
                    field("seed", path(&StudyResult::settings, &StudySettings::seed), "seed of the study"),
                    field("by_contact", path(&StudyResult::settings, &StudySettings::has_contact),
                          "runs were made by the hand; false: judged by geometry alone"),
                    field("good", &StudyResult::good, "runs that fit"),
                    field("blocked", &StudyResult::blocked, "runs that geometry rules out"),
                    field("yield", &StudyResult::yield, "share of the runs that fit"),
                    field("yield_low", &StudyResult::yield_low, "lower end of Wilson's interval of 95 %"),
                    field("yield_high", &StudyResult::yield_high, "upper end"),
                    list("effects", &StudyResult::effects, kStudyEffectFields),
                    list("runs", &StudyResult::runs, kStudyRunFields));

}  // namespace vps::scenes
