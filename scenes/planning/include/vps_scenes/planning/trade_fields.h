// SPDX-License-Identifier: BSD-3-Clause
// Field tables of a trade study, for JSON and CSV.
#pragma once

#include "vps_scenes/planning/fidelity_choice.h"
#include "vps_scenes/planning/trade.h"
#include "vps_scenes/run/result_fields.h"
#include "vps_scenes/scene/settings_fields.h"

namespace vps::scenes {

inline constexpr auto kProbeFields = std::make_tuple(
    field("distance_error_m", path(&TradeRow::probe, &ProbeErrors::distance_m),
          "worst error of the least distance"),
    field("penetration_error_m", path(&TradeRow::probe, &ProbeErrors::penetration_m),
          "worst error of the depth"),
    field("force_error", path(&TradeRow::probe, &ProbeErrors::force), "median relative error of the force"),
    field("torque_error", path(&TradeRow::probe, &ProbeErrors::torque),
          "median relative error of the torque"),
    field("points_read", &TradeRow::points_read, "mean number of points that a query tests"));

inline constexpr auto kTradeRunFields = std::make_tuple(
    field("completed", &TradeRun::completed, "the run completed all of its steps"),
    field("max_penetration_m", &TradeRun::deepest_m, "deepest penetration, by exact distance"),
    field("final_error_m", &TradeRun::final_error_m, "worst distance of a part's origin from its target"),
    field("peak_force_N", &TradeRun::peak_force_N, "greatest force on the virtual hand"),
    field("to_hand_J", &TradeRun::to_hand_J, "work done on the virtual hand"),
    field("injected_J", &TradeRun::injected_J,
          "greatest energy that the simulation added, as `energy.injected_J` of `assemble`"),
    field("contacts_left_out", &TradeRun::contacts_left_out,
          "near points left out because a query's list was full"),
    field("bytes", &TradeRun::bytes, "memory of all models, with the cooked field"));

inline constexpr auto kReferenceFields = std::make_tuple(
    field("final_m", &RunErrors::final_m, "distance between the last parts' final positions"),
    field("peak_force_N", &RunErrors::peak_force_N, "difference of the peak forces on the virtual hand"),
    field("to_hand_J", &RunErrors::to_hand_J, "difference of the work done on the virtual hand"));

inline constexpr auto kTradeRowFields = std::make_tuple(
    field("name", path(&TradeRow::setting, &TradeSetting::name), "name of the row's setting"),
    field("knob", path(&TradeRow::setting, &TradeSetting::knob), "the setting that the row changes"),
    group("fidelity", path(&TradeRow::setting, &TradeSetting::fidelity), kFidelityFields,
          "as `[fidelity]` of a scene file, in SI"),
    field("points", &TradeRow::points, "points of all pointshells"),
    field("models_bytes", &TradeRow::bytes, "memory of the parts' models"),
    group("probe", when(&TradeRow::has_probe), kProbeFields),
    group("", when(&TradeRow::has_run), std::make_tuple(group("run", &TradeRow::run, kTradeRunFields))),
    group("", when(&TradeRow::has_reference),
          std::make_tuple(group("off_reference", &TradeRow::off, kReferenceFields))));

inline constexpr auto kTradeRowWallFields = std::make_tuple(
    field("models_s", &TradeRow::models_wall_s, "time to build the models that no earlier row had built"),
    field("on_front", &TradeRow::is_on_front,
          "no other row is as fast, as small in memory and as accurate as this row"),
    group("", when(&TradeRow::has_probe),
          std::make_tuple(group("query_us", &TradeRow::query, kProcessorTimes, "wrench query of a pose"),
                          group("all_points_us", &TradeRow::all_points, kProcessorTimes,
                                "wrench query of a pose over all points, without the tree"))),
    group(
        "", when(&TradeRow::has_run),
        std::make_tuple(
            field("build_s", path(&TradeRow::run, &TradeRun::build_wall_s), "time to build the run's models"),
            field("run_s", path(&TradeRow::run, &TradeRun::wall_s), "time of the run"),
            group("physics_us", path(&TradeRow::run, &TradeRun::physics), kProcessorTimes, "physics step"),
            group("haptic_us", path(&TradeRow::run, &TradeRun::haptic), kProcessorTimes, "haptic tick"),
            field("rate_hz", &rateOf, "physics rate that `physics_us.cpu_p99` allows"))));

inline constexpr auto kChoiceFields = std::make_tuple(
    field("is_met", &FidelityChoice::is_met, "a fidelity keeps all bounds"),
    field("failure_reason", &FidelityChoice::failure_reason, "which bound cannot be kept, and the remedy"),
    group("fidelity", &FidelityChoice::fidelity, kFidelityFields, "as `[fidelity]` of a scene file, in SI"),
    field("error_m", &FidelityChoice::error_m, "measured error of depth that 95 of 100 points do not exceed"),
    field("points", &FidelityChoice::points, "points of all pointshells"),
    field("points_near", &FidelityChoice::points_near, "points that may be near contact in a step"),
    field("bytes", &FidelityChoice::bytes, "memory of all models, with the cooked field"),
    field("step_by_model_us", &FidelityChoice::step_us,
          "step time estimated by the cost model; no time is measured"));
static_assert(coversAllMembers<FidelityChoice>(kChoiceFields));

}  // namespace vps::scenes
