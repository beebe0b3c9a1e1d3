// SPDX-License-Identifier: BSD-3-Clause
// The result of a run: the numbers of reports, plots and JSON. result_fields.h has a row for each of these
// numbers.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vps/wrench.h"
#include "vps_scenes/export.h"
#include "vps_scenes/run/snapshot.h"
#include "vps_scenes/run/verdict.h"
#include "vps_scenes/scene/model_options.h"

namespace vps::scenes {

/// Wall-clock statistics of a repeated task [microseconds].
struct TickTimes {
  std::uint64_t count = 0;
  std::uint64_t missed = 0;  ///< ticks that took longer than the period
  double p50_us = 0, p99_us = 0, p999_us = 0, max_us = 0, mean_us = 0;
  /// Processor time of the thread, which excludes the time of other programs. 0: not measured.
  double cpu_p50_us = 0, cpu_p99_us = 0;
};

/// One strategy that the virtual operator used while it inserted or pressed.
struct StrategyUse {
  std::string strategy;  ///< name of the strategy, such as "tilt_in" (vps_device/operator.h)
  double start_s = 0, duration_s = 0;
};

struct StepResult {
  std::string part;
  Verdict verdict = Verdict::NotShown;
  std::string reason;  ///< reason of the verdict; empty when the part fits
  std::string
      blocked_by;  ///< the part whose geometry proves that this part cannot be at its target; empty: none
  Vec3 blocked_at_W = Vec3::Zero();
  double blocked_depth_m = 0, blocked_error_m = 0;
  std::string stuck_against;  ///< the part that this part touched when the hand gave up; empty: none, or the
                              ///< hand did not give up
  Vec3 stuck_at_W = Vec3::Zero();
  std::string stands_on;  ///< an earlier part that did not reach its target and was put at its target for
                          ///< this step; empty: none
  /// A later part that fits into this part and moves it from where the hand left it to its target; empty:
  /// none, or the path to the target is not free.
  std::string aligned_by;
  /// Why a run cannot show that the part fits: the known error of the meshes exceeds its clearance, or no
  /// other part is near its target; empty: a run can show it.
  std::string mesh_doubt;
  /// Why it is not proven that the overlap with blocked_by stays wherever the parts are near their drawn
  /// places, in words; empty if it is proven, or if there is no such overlap.
  std::string overlap_doubt;
  /// How far the part's target was moved [m] from the drawn place, so that no parts overlap: the part itself,
  /// or a part near it, overlaps another one as drawn (CheckedPlaces); 0: not moved.
  double moved_m = 0;
  bool is_taken_off = false;  ///< the step took the part off, and its target is where it was put away
  bool completed = false;     ///< the part reached its target, whatever else is wrong
  bool by_contact = false;    ///< completed, and other parts guided the part to its target: isGuided()
  /// Greatest force across the last leg of the part's path while the part was in hand: the force that guides
  /// the part.
  double guide_force_N = 0;
  std::string failure_reason;  ///< empty when completed
  double start_s = 0, duration_s = 0;
  double max_penetration_m = 0;  ///< by exact mesh distance, during the step and the time after release
  std::string deepest_against;
  Vec3 deepest_at_W = Vec3::Zero();
  double deepest_time_s = 0;
  double penetration_limit_m = 0;               ///< min(10 um, clearance / 4), see result_fields.h
  double field_penetration_m = 0;               ///< deepest penetration by the voxmap, for comparison
  double peak_force_N = 0, peak_torque_Nm = 0;  ///< greatest force and torque on the hand
  int impacts = 0, slides = 0;
  int index_count = 0;                  ///< number of times that the device was clutched and recentred
  std::vector<StrategyUse> strategies;  ///< in order of time; empty if a person moves the part
  double turns = 0;                     ///< turns of a screw the last time it was screwed on
  double advance_per_turn_m = 0;        ///< the screw's travel along its axis, divided by `turns`
  double lean_rad = 0;  ///< greatest angle between the screw's axis and its target axis during `turns`
  /// Force that presses the part in, by Lame's formula for the declared interference; 0: check finds no press
  /// fit.
  double press_needed_N = 0;
  double hoist_N =
      0;  ///< share of the part's weight [N] that a hoist carries since the hand cannot; 0: no hoist
  double tolerance_m = 0;    ///< tolerance of final_error_m, as stated or from the fit
  double final_error_m = 0;  ///< greatest distance of the part's surface from its place at the target
  double final_error_rad = 0;
  double rest_drift_m = 0;  ///< greatest displacement of any point of the part in rest_s after release
  double late_drift_m = 0;  ///< rest_drift_m from half of rest_s on, relative to the pose at that time
  /// The part was not at rest, but it moved only as its play lets it, as a ball that rolls in its hole.
  bool moves_in_play = false;
  double rest_s = 0;
  double cook_wall_s = 0;  ///< time to build the fixed field of the next step, on its own thread
  double swap_wall_s = 0;  ///< time to put the next fixed field in place, between two physics steps
  std::uint64_t missed_while_cooking = 0;  ///< haptic periods missed during cooking, in real time
};

/// Least guide_force_N of a part that other parts guided. Measured (tests/hand): at most 0.01 N over a plate
/// with nothing beside the part, at least 0.036 N in a bore.
inline constexpr double kGuideLeast_N = 0.02;
inline bool isGuided(const StepResult& step) {
  return step.guide_force_N >= kGuideLeast_N;
}
/// Report, table, JSON and exit status all show the verdict; no other criterion decides whether the parts
/// fit.
inline bool isGood(const StepResult& step) {
  return isGood(step.verdict);
}

/// @param hand_N  greatest force of the hand
inline Evidence evidenceOf(const StepResult& step, double hand_N) {
  std::string blocked;
  if (!step.blocked_by.empty())
    blocked = step.reason.empty() ? "blocked by '" + step.blocked_by + "'" : step.reason;
  return {.blocked = std::move(blocked),
          .is_in_place = step.completed,
          .failure = step.failure_reason,
          .depth_m = step.max_penetration_m,
          .depth_limit_m = step.penetration_limit_m,
          .deepest_against = step.deepest_against,
          .rest_drift_m = step.rest_drift_m,
          .late_drift_m = step.late_drift_m,
          .moves_in_play = step.moves_in_play,
          .press_needed_N = step.press_needed_N,
          .hand_N = hand_N,
          .is_taken_off = step.is_taken_off,
          .doubt = step.mesh_doubt};
}
inline bool isWithinLimit(const StepResult& step) {
  return evidenceOf(step, 0).isWithinLimit();
}
inline bool isAtRest(const StepResult& step) {
  return evidenceOf(step, 0).isAtRest();
}

/// Verdict of a run with `planned` steps: the worst of its steps, and at best NotShown if a step was not
/// tried.
inline Verdict verdictOf(const std::vector<StepResult>& steps, std::size_t planned) {
  Verdict worst = steps.size() < planned ? Verdict::NotShown : Verdict::Fits;
  for (const StepResult& step : steps) worst = worse(worst, step.verdict);
  return worst;
}

/// Phase of the hand's work on the part.
enum class TracePhase { Reach, Insert, Press, Rest };

/// One row of the time series (figure 9 of Tripicchio et al.).
struct TraceRow {
  double time_s = 0;
  int step = -1;
  int phase = 0;     ///< a TracePhase
  int strategy = 0;  ///< a device::OperatorStrategy
  Wrench F_hand_W;   ///< wrench on the hand
  Pose X_WP;         ///< pose of the part in hand
  Pose X_W_Proxy;
  int contacts = 0;
  double depth_m = 0;  ///< penetration depth by the voxmap
};

struct EnergyLedger {
  double to_hand_J = 0, from_hand_J = 0;
  double injected_J = 0;                  ///< energy that the loop generated, by the encoders' positions
  double quantisation_error_bound_J = 0;  ///< error bound of injected_J, by the encoders' resolution
};

/// A part that turned in one physics step by more than the limit. Contacts between bodies that turn by more
/// than 0.1 rad relative to each other miss teeth and corners, and above 45 degrees Bullet turns a body by
/// less than its speed requires.
struct FastTurn {
  std::string part;
  bool is_in_contact = false;  ///< the part touches another part, and the rotation is relative to that part
  double w_rad_s = 0;          ///< angular velocity at which the part needs the highest physics rate
  double turn_rad = 0;         ///< rotation at w_rad_s in one step, or one substep (Fidelity::substeps)
  double limit_rad = 0;        ///< greatest rotation in one step that is simulated correctly
  double needed_hz =
      0;  ///< Fidelity::physics_rate_hz at which the rotation stays within the limit, without substeps
};
/// The fast turn in words, such as "'shaft' turns with 10000 rpm, ...", with the remedy.
VPS_SCENES_API std::string inWords(const FastTurn& turn);

/// One change of the load level (load_level.h).
struct LoadLevelChange {
  double time_s = 0;      ///< simulated
  int from = 0, to = 0;   ///< indices of kLoadLevels
  std::string was, is;    ///< both levels in words
  std::string why;        ///< the measurement that caused the change
  std::string cost;       ///< the error that the change causes, or the setting that the change restores
  double lost_share = 0;  ///< share of the physics periods of the last quarter of a second that had no step
  /// Greatest distance from any place of the surface to the nearest tested point: a deeper contact is always
  /// detected.
  double unseen_bound_m = 0;
  /// Least distance measured with the new points minus the least distance measured with the old points, at
  /// the part's pose; none if the distance was beyond the map's band.
  std::optional<double> misread_m;
  double k_N_per_m = 0;     ///< coupling stiffness after the change
  double build_wall_s = 0;  ///< for new points: time from the decision to their use
  bool is_done = true;      ///< false: the change failed, and `why` gives the reason
};

/// Timing of a run in real time.
struct RealTimeResult {
  bool has_priority = false, has_locked_memory = false;
  std::vector<std::string> warnings;  ///< what the operating system refused, with the remedy
  TickTimes late;                     ///< times from a tick's due time to its start
  TickTimes response;                 ///< times from a tick's due time to its wrench
  std::vector<std::pair<std::string, std::uint64_t>> missed_by;  ///< missed haptic periods by cause
  std::uint64_t stale_ticks = 0;  ///< ticks that used a pose of the part older than two physics steps
  std::uint64_t worst_tick = 0;   ///< number of the tick with the longest response
  double worst_us = 0;
  std::string worst_cause;
  TickTimes physics_late;                     ///< times from a physics step's due time to its start
  std::uint64_t physics_missed = 0;           ///< periods of the scene's physics rate without a physics step
  double behind_s = 0;                        ///< lag of simulated time behind real time while physics ran
  std::vector<LoadLevelChange> load_changes;  ///< in order of time
  std::uint64_t faults = 0;                   ///< number of safety faults
};

/// Result of one of several runs of the same procedure (assembleTries()).
struct TryResult {
  std::uint64_t seed = 0;  ///< seed of the virtual operator
  Verdict verdict = Verdict::NotShown;
  double simulated_s = 0;
  std::string reason;  ///< "part: reason" of the first step whose part does not fit; empty when all parts fit
};

struct CheckResult;

struct AssembleResult {
  std::string scene;
  Verdict verdict =
      Verdict::NotShown;  ///< result of verdictOf(): worst step, at best NotShown if a step was not tried
  bool completed = false;
  std::vector<StepResult> steps;
  std::vector<TryResult> tries;  ///< in order of their seeds; empty for a single run
  /// Ease of assembly: share of the tries in which every part reached its target.
  std::optional<double> ease_share;
  std::vector<TraceRow> trace;
  std::vector<Snapshot> start, contact, end;  ///< one snapshot for each step, for pictures
  Snapshot finished;
  double haptic_rate_hz = 0, physics_rate_hz = 0;
  /// Result of the check of the drawn parts (check.h), without play, which the run makes before its first
  /// step. Null: no check was made.
  std::shared_ptr<const CheckResult> checked;
  TickTimes haptic, physics;
  std::optional<RealTimeResult> real_time;  ///< set in a run in real time
  struct {
    std::uint64_t held = 0;                  ///< number of ticks that used the last snapshot unchanged
    double jump_J = 0, greatest_jump_m = 0;  ///< energy and displacement that new snapshots caused
  } local_contact;
  EnergyLedger energy;
  ModelledCost modelled;  ///< greatest cost during the run, with the fixed field
  int widened = 0;        ///< number of times that a part left its region, so that more was modelled
  std::vector<FastTurn> fast_turns;  ///< one for each part that turned too fast for its steps
  std::size_t contacts_left_out =
      0;  ///< number of near points beyond a query's limit; 0 unless a limit was set
  double simulated_s = 0, build_wall_s = 0, run_wall_s = 0;
};

}  // namespace vps::scenes
