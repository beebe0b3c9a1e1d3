// SPDX-License-Identifier: BSD-3-Clause
// The numbers of a run as JSON and CSV show them: one table for each object, in its order.
// viewer/cli/JSON.md is made from them. Figures of the wall clock have tables of their own, since they do
// not repeat.
#pragma once

#include <vector>

#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/fields.h"

namespace vps::scenes {

// --- TickTimes: the figures that each place shows

inline constexpr auto kPercentiles = std::make_tuple(
    field("p50", &TickTimes::p50_us, "median"), field("p99", &TickTimes::p99_us, "99th percentile"),
    field("p999", &TickTimes::p999_us, "99.9th percentile"), field("max", &TickTimes::max_us, "longest"));

inline constexpr auto kShortTimes = std::make_tuple(field("median", &TickTimes::p50_us, "median"),
                                                    field("p99", &TickTimes::p99_us, "99th percentile"),
                                                    field("max", &TickTimes::max_us, "longest"));

inline constexpr auto kProcessorTimes = std::make_tuple(
    field("median", &TickTimes::p50_us, "median"), field("p99", &TickTimes::p99_us, "99th percentile"),
    field("cpu_median", &TickTimes::cpu_p50_us, "median of the thread's processor time"),
    field("cpu_p99", &TickTimes::cpu_p99_us, "99th percentile of the thread's processor time"));

inline constexpr auto kLoopTimes =
    std::make_tuple(field("missed", &TickTimes::missed, "ticks that took longer than the period"),
                    object("tick_us", kPercentiles, "duration of a tick, or of a physics step"));

// --- A step of the procedure

inline constexpr auto kStepFields = std::make_tuple(
    field("part", &StepResult::part, "name of the part"),
    field("verdict", &StepResult::verdict, "`fits`, `blocked` or `not_shown`"),
    field("reason", &StepResult::reason, "reason of the verdict; empty when the part fits"),
    field("blocked_by", &StepResult::blocked_by,
          "the part that the moved part, as drawn, overlaps at its target, or whose closed cavity shuts the "
          "moved part in or out; empty if none"),
    field("blocked_at_m", &StepResult::blocked_at_W, "where the overlap with `blocked_by` is, in the world"),
    field("blocked_depth_m", &StepResult::blocked_depth_m, "depth of the overlap with `blocked_by`"),
    field("blocked_error_m", &StepResult::blocked_error_m,
          "error of `blocked_depth_m`: the distance of the meshes from the exact faces"),
    field("stuck_against", &StepResult::stuck_against,
          "the part that the moved part touched when the hand gave up; empty if none, or if the hand did not "
          "give up"),
    field("stuck_at_m", &StepResult::stuck_at_W,
          "where the moved part touched `stuck_against`, in the world"),
    field("stands_on", &StepResult::stands_on,
          "an earlier part that did not reach its target and was put at its target for this step; empty if "
          "none"),
    field("overlap_doubt", &StepResult::overlap_doubt,
          "why it is not proven that the overlap with `blocked_by` stays wherever the parts are near their "
          "drawn places, in words; empty if it is proven or if there is no such overlap"),
    field(
        "moved_m", &StepResult::moved_m,
        "how far the part's target was moved from the drawn place, so that neither the part nor a part near "
        "it overlaps another one; 0 if not moved"),
    field("mesh_doubt", &StepResult::mesh_doubt,
          "why the run does not show that the part fits, although the hand brought the part to its target: "
          "the known error of the meshes exceeds the part's clearance, no other part is near its target, or "
          "a motion between two steps was not searched to its end; empty: no doubt"),
    field("aligned_by", &StepResult::aligned_by,
          "a later part that fits into the step's part and moves the step's part from where the hand left it "
          "to its target; empty if none"),
    field("taken_off", &StepResult::is_taken_off,
          "the step took the part off (`--disassemble`); the part's target is where it was put away"),
    field("completed", &StepResult::completed, "the part reached its target within tolerance"),
    field("by_contact", &StepResult::by_contact,
          "completed, and other parts guided the part across its path; false: placed by sight alone"),
    field("guide_force_N", &StepResult::guide_force_N,
          "greatest force across the last leg of the part's path while the part was in hand"),
    field("failure_reason", &StepResult::failure_reason,
          "why the part did not reach its target; empty when completed"),
    field("start_s", &StepResult::start_s, "simulated time at which the step began"),
    field("duration_s", &StepResult::duration_s, "simulated time that the step took"),
    field("max_penetration_m", &StepResult::max_penetration_m,
          "deepest penetration during the step and the time after release, by exact distance along all sharp "
          "edges, at the vertices of curved faces and at the shells' points on faces, at every 20th pose and "
          "the fifty with the deepest contacts, and on motions between the poses of two physics steps that "
          "are more than 0.1 mm apart"),
    field("penetration_limit_m", &StepResult::penetration_limit_m,
          "limit of the penetration: min(10 um, clearance / 4); for a part that is taken off, in addition to "
          "the overlap as drawn"),
    field("deepest_against", &StepResult::deepest_against, "name of the part that was penetrated deepest"),
    field("deepest_at_m", &StepResult::deepest_at_W, "place of the deepest penetration, in the world"),
    field("deepest_time_s", &StepResult::deepest_time_s, "simulated time of the deepest penetration"),
    field("field_penetration_m", &StepResult::field_penetration_m,
          "deepest penetration by the voxmap, for comparison"),
    field("peak_force_N", &StepResult::peak_force_N, "greatest force on the hand"),
    field("peak_torque_Nm", &StepResult::peak_torque_Nm, "greatest torque on the hand"),
    field("impacts", &StepResult::impacts, "number of impacts"),
    field("slides", &StepResult::slides, "number of contacts that slide"),
    field("index_count", &StepResult::index_count,
          "number of times that the device was clutched and recentred, on a path longer than the device's "
          "workspace or a rotation beyond its range"),
    field("turns", &StepResult::turns, "number of turns of a screw, the last time that it was screwed on"),
    field("advance_per_turn_m", &StepResult::advance_per_turn_m,
          "travel of a screw along its axis during `turns`, divided by `turns`"),
    field("lean_rad", &StepResult::lean_rad,
          "greatest angle between the axis of a screw and the axis of its target during `turns`"),
    field("press_needed_N", &StepResult::press_needed_N,
          "force that presses the part in, by Lamé's formula for the declared interference; 0: not a press "
          "fit"),
    field("hoist_N", &StepResult::hoist_N,
          "share of the weight that a hoist carries, since the weight exceeds half of the coupling's "
          "greatest force; forces on the hand are then those of a lighter part; 0: no hoist"),
    field("tolerance_m", &StepResult::tolerance_m, "tolerance of `final_error_m`, as stated or from the fit"),
    field("final_error_m", &StepResult::final_error_m,
          "greatest distance of the part's surface from its place at the target"),
    field("final_error_rad", &StepResult::final_error_rad, "rotation from the target"),
    field("rest_drift_m", &StepResult::rest_drift_m,
          "greatest displacement of any point of the part in `rest_s` after release"),
    field("late_drift_m", &StepResult::late_drift_m,
          "greatest displacement of any point of the part in the second half of `rest_s`; more than 5 um: "
          "the part is not at rest, unless it `moves_in_play`"),
    field("moves_in_play", &StepResult::moves_in_play,
          "the part was not at rest, but moved only as its play lets it, as a ball that rolls in its hole"),
    field("rest_s", &StepResult::rest_s, "simulated time that the part was watched after release"));

inline constexpr auto kStrategyFields = std::make_tuple(
    field("strategy", &StrategyUse::strategy,
          "strategy of the virtual operator: device/VIRTUAL_OPERATOR.md lists them"),
    field("start_s", &StrategyUse::start_s, "simulated time at which the strategy began"),
    field("duration_s", &StrategyUse::duration_s, "simulated time for which the strategy was used"));
static_assert(coversAllMembers<StrategyUse>(kStrategyFields));

/// Lists, which a table of steps has no column for.
inline constexpr auto kStepLists =
    std::make_tuple(list("strategies", &StepResult::strategies, kStrategyFields));

inline constexpr auto kStepWallFields =
    std::make_tuple(field("cook_s", &StepResult::cook_wall_s,
                          "time to build the fixed field of the next step, on its own thread"),
                    field("swap_s", &StepResult::swap_wall_s,
                          "time to put the next step's field in place, between two physics steps"),
                    field("missed_while_cooking", &StepResult::missed_while_cooking,
                          "haptic periods missed while the field was built, in real time"));
static_assert(coversAllMembers<StepResult>(kStepFields, kStepLists, kStepWallFields));

// --- Parts of the result of a run

inline constexpr auto kEnergyFields =
    std::make_tuple(field("to_hand_J", &EnergyLedger::to_hand_J, "work done on the hand"),
                    field("from_hand_J", &EnergyLedger::from_hand_J, "work done by the hand"),
                    field("injected_J", &EnergyLedger::injected_J,
                          "greatest energy that the simulation added, by the positions of the encoders"),
                    field("quantisation_error_bound_J", &EnergyLedger::quantisation_error_bound_J,
                          "bound of the error of `injected_J` by the encoders' resolution"));
static_assert(coversAllMembers<EnergyLedger>(kEnergyFields));

/// A part that turned in one step by more than the limit.
inline constexpr auto kFastTurnFields = std::make_tuple(
    field("part", &FastTurn::part, "name of the part"),
    field("in_contact", &FastTurn::is_in_contact, "`turn_rad` is the rotation relative to a part in contact"),
    field("angular_velocity_rad_s", &FastTurn::w_rad_s,
          "angular velocity at which the part needs the shortest step"),
    field("turn_rad", &FastTurn::turn_rad, "rotation of the part in a step or substep (`substeps`)"),
    field("limit_rad", &FastTurn::limit_rad,
          "greatest rotation that is simulated correctly: 0.1 between bodies in contact, else the limit of "
          "Bullet"),
    field("needed_hz", &FastTurn::needed_hz,
          "`physics_rate_hz` that keeps the rotation within the limit, without `substeps`"));
static_assert(coversAllMembers<FastTurn>(kFastTurnFields));

inline constexpr auto kModelledFields =
    std::make_tuple(field("voxmaps", &ModelledCost::voxmaps, "number of voxmaps"),
                    field("pointshells", &ModelledCost::pointshells, "number of pointshells"),
                    field("points", &ModelledCost::points, "points of the parts' own pointshells"),
                    field("field_points", &ModelledCost::field_points, "points of the fixed field"),
                    field("bytes", &ModelledCost::bytes, "memory of all models"));
static_assert(coversAllMembers<ModelledCost>(kModelledFields));

inline constexpr auto kLoadChangeFields = std::make_tuple(
    field("time_s", &LoadLevelChange::time_s, "simulated time"),
    object("from", std::make_tuple(field("level", &LoadLevelChange::from, "load level before"),
                                   field("words", &LoadLevelChange::was, "load level before, in words"))),
    object("to", std::make_tuple(field("level", &LoadLevelChange::to, "load level after"),
                                 field("words", &LoadLevelChange::is, "load level after, in words"))),
    field("is_done", &LoadLevelChange::is_done,
          "false: the change was not possible, and `why` gives the reason"),
    field("why", &LoadLevelChange::why, "reason for the change"),
    field("lost_share", &LoadLevelChange::lost_share,
          "share of the physics periods of the last quarter of a second that had no step"),
    field("cost", &LoadLevelChange::cost, "effect on accuracy, in words"),
    field("unseen_bound_m", &LoadLevelChange::unseen_bound_m,
          "greatest depth of a contact between the points that can go undetected"),
    field("misread_m", &LoadLevelChange::misread_m,
          "least distance measured with the new points minus the least distance measured with the old "
          "points; null beyond the voxmap's band"),
    field("k_N_per_m", &LoadLevelChange::k_N_per_m, "stiffness of the coupling after the change"),
    field("build_s", &LoadLevelChange::build_wall_s, "time from the decision to the effect of the change"));
static_assert(coversAllMembers<LoadLevelChange>(kLoadChangeFields));

inline constexpr auto kRealTimeHapticFields = std::make_tuple(
    field("missed_by", &RealTimeResult::missed_by, "missed periods by cause"),
    group("late_us", &RealTimeResult::late, kPercentiles, "time from a tick's due time to its start"),
    group("response_us", &RealTimeResult::response, kPercentiles,
          "time from a tick's due time to its wrench"),
    object("worst", std::make_tuple(
                        field("tick", &RealTimeResult::worst_tick, "number of the slowest tick"),
                        field("response_us", &RealTimeResult::worst_us,
                              "time from the slowest tick's due time to its wrench"),
                        field("cause", &RealTimeResult::worst_cause, "cause of the slowest tick's delay"))),
    field("stale_ticks", &RealTimeResult::stale_ticks,
          "ticks that used a pose of the part older than two physics steps"),
    field("faults", &RealTimeResult::faults, "faults of the safety chain"),
    field("has_priority", &RealTimeResult::has_priority, "the thread has real-time priority"),
    field("has_locked_memory", &RealTimeResult::has_locked_memory, "the memory is locked"),
    field("warnings", &RealTimeResult::warnings,
          "requests for real time (priority, locked memory) that the operating system refused, each with its "
          "remedy"));

inline constexpr auto kRealTimePhysicsFields = std::make_tuple(
    group("late_us", &RealTimeResult::physics_late, kPercentiles, "time from a step's due time to its start"),
    field("missed_periods", &RealTimeResult::physics_missed, "physics periods without a physics step"),
    field("behind_s", &RealTimeResult::behind_s, "lag of simulated time behind real time"),
    list("load_changes", &RealTimeResult::load_changes, kLoadChangeFields));
static_assert(coversAllMembers<RealTimeResult>(kRealTimeHapticFields, kRealTimePhysicsFields));

// --- A run

using LocalContact = decltype(AssembleResult::local_contact);

inline constexpr auto kTryFields = std::make_tuple(
    field("seed", &TryResult::seed, "seed of the virtual operator"),
    field("verdict", &TryResult::verdict, "`fits`, `blocked` or `not_shown`"),
    field("simulated_s", &TryResult::simulated_s, "simulated time"),
    field("reason", &TryResult::reason, "reason of the first step that does not fit; empty when all fit"));
static_assert(coversAllMembers<TryResult>(kTryFields));

inline constexpr auto kAssembleFields = std::make_tuple(
    field("scene", &AssembleResult::scene, "name of the scene"),
    field("verdict", &AssembleResult::verdict, "`fits`, `blocked` or `not_shown`"),
    field("completed", &AssembleResult::completed, "all steps were completed"),
    field("contacts_left_out", &AssembleResult::contacts_left_out,
          "near points that found no room in a query; 0 unless a limit was set"),
    field("simulated_s", &AssembleResult::simulated_s, "simulated time"),
    list("steps", &AssembleResult::steps, std::tuple_cat(kStepFields, kStepLists)),
    list("fast_turns", &AssembleResult::fast_turns, kFastTurnFields),
    list("tries", &AssembleResult::tries, kTryFields),
    field("ease_of_assembly", &AssembleResult::ease_share,
          "share of the tries in which every part reached its target; null for a single run"),
    object("haptic",
           std::make_tuple(
               field("rate_hz", &AssembleResult::haptic_rate_hz, "rate of the haptic loop"),
               field("ticks", path(&AssembleResult::haptic, &TickTimes::count), "number of haptic ticks"))),
    object("physics", std::make_tuple(field("rate_hz", &AssembleResult::physics_rate_hz, "rate of physics"),
                                      field("ticks", path(&AssembleResult::physics, &TickTimes::count),
                                            "number of physics steps"))),
    group("energy", &AssembleResult::energy, kEnergyFields),
    group("local_contact", &AssembleResult::local_contact,
          std::make_tuple(
              field("held_ticks", &LocalContact::held, "ticks that used the last snapshot unchanged"),
              field("jump_J", &LocalContact::jump_J, "energy of the jumps at new snapshots"),
              field("greatest_jump_m", &LocalContact::greatest_jump_m, "greatest jump at a new snapshot"))),
    field("widened", &AssembleResult::widened,
          "number of times that a part reached the border of its region, so that more of the surrounding "
          "parts was modelled"),
    group("modelled", &AssembleResult::modelled, kModelledFields));

inline constexpr auto kAssembleWallFields = std::make_tuple(
    field("build_s", &AssembleResult::build_wall_s, "time to build the models"),
    field("run_s", &AssembleResult::run_wall_s, "time of the run"),
    columns(&AssembleResult::steps, kStepWallFields),
    object("haptic", std::make_tuple(group("", &AssembleResult::haptic, kLoopTimes),
                                     group("", &AssembleResult::real_time, kRealTimeHapticFields))),
    object("physics", std::make_tuple(group("", &AssembleResult::physics, kLoopTimes),
                                      group("", &AssembleResult::real_time, kRealTimePhysicsFields))));

// --- A row of trace.csv; a vector's columns are "force_x_N" and so on, a pose's "part_x_m" to "part_qw"

inline constexpr auto kTraceFields = std::make_tuple(
    field("time_s", &TraceRow::time_s, "simulated time"), field("step", &TraceRow::step, "index of the step"),
    field("phase", &TraceRow::phase, "0 reach, 1 insert, 2 press, 3 rest"),
    field("force_N", path(&TraceRow::F_hand_W, &Wrench::f), "force on the hand, in the world"),
    field("torque_Nm", path(&TraceRow::F_hand_W, &Wrench::tau), "torque on the hand, in the world"),
    field("part", &TraceRow::X_WP, "pose of the part in hand"),
    field("proxy", &TraceRow::X_W_Proxy, "pose of the device's proxy"),
    field("contacts", &TraceRow::contacts, "number of contacts"),
    field("depth_m", &TraceRow::depth_m, "deepest penetration by the voxmap"),
    field("strategy", &TraceRow::strategy,
          "number of the strategy's row in VPS_OPERATOR_STRATEGIES (vps_device/operator.h), from 1; 0 none"));

}  // namespace vps::scenes
