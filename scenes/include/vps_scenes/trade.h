// SPDX-License-Identifier: BSD-3-Clause
// Speed against accuracy, measured on a scene of the user's own.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/model_options.h"
#include "vps_scenes/result.h"
#include "vps_scenes/scene.h"

namespace vps::scenes {

/// What a row changes against the scene's own fidelity.
enum class TradeKnob {
  Own,  ///< nothing
  Voxel,
  Spacing,
  Sides,
  Gradient,
  Contact,
  ContactLimit,
  HapticRate,
  PhysicsRate,
  SolverIterations,
  Together,   ///< several
  Reference,  ///< all, far finer: what the others' runs are compared with
};
VPS_SCENES_API const char* toText(TradeKnob knob);

/// A setting to measure.
struct TradeTry {
  std::string name;  ///< "voxel x2"
  TradeKnob knob = TradeKnob::Own;
  Fidelity fidelity;
  ContactMethod contact = ContactMethod::Constraint;
};

/// What the models say at the probe's poses, against the exact surfaces of the meshes.
struct ProbeErrors {
  double distance_m = 0;     ///< worst error of the least distance (negative: depth), over all poses
  double penetration_m = 0;  ///< worst error of the depth, over the poses that are inside
  double force = 0;          ///< median of |F - F_exact| / |F_exact|, over the poses that are inside
  double torque = 0;         ///< the same of the torque about the part's origin
};

/// What a run of the procedure came to.
struct TradeRun {
  bool completed = false;
  double deepest_m = 0;      ///< by exact distance, over the steps
  double final_error_m = 0;  ///< worst distance of a part's origin from its designed target
  double peak_force_N = 0;   ///< on the hand
  double to_hand_J = 0, injected_J = 0;
  Vec3 p_W_end = Vec3::Zero();  ///< where the last part's origin came to rest
  std::size_t contacts_left_out = 0;
  std::size_t bytes = 0;  ///< with the cooked field
  double build_wall_s = 0, wall_s = 0;
  TickTimes physics, haptic;
};

/// How a run differs from the reference run.
struct RunErrors {
  double final_m = 0, peak_force_N = 0, to_hand_J = 0;
};

struct TradeRow {
  TradeTry what;
  std::size_t points = 0, bytes = 0;
  bool has_probe = false, has_run = false, has_reference = false;
  ProbeErrors probe;
  double points_read = 0;       ///< mean of a query, both sides
  TickTimes query, all_points;  ///< wrench query with the tree, and without: a pose, both sides
  double models_wall_s = 0;     ///< building what this row needed and no earlier row had
  TradeRun run;
  RunErrors off;
  bool is_on_front = false;  ///< no other row is at least as quick, as small and as true, and better in one
};

struct TradeOptions : ModelOptions {
  double seconds = 45;  ///< wall-clock time that may be spent; the last run is cut where it would be more
  bool is_thorough = false;  ///< all steps, all settings, whatever it takes
  const std::atomic<bool>* stop = nullptr;
};

struct TradeResult {
  std::string scene;
  std::string excerpt;  ///< what was run, in words: "step 1 of 9: bushing_lower"
  std::size_t poses = 0, poses_inside = 0;
  double reference_spacing_m = 0;  ///< of the samples that the exact wrench is summed over
  std::vector<TradeRow> rows;
  std::vector<std::string> left_out;  ///< what there was no time for, one line each
  std::vector<std::string> fixed;     ///< what a scene cannot choose, and why, one line each
};

/// How far off depth may be with a row's setting: the most by which the models misread it at the probe's
/// poses, or the deepest that its run let a part go, whichever is more.
VPS_SCENES_API double errorOf(const TradeRow& row);
/// The physics rate that the row's 99th percentile of processor time a step allows [Hz]; 0 without a run.
VPS_SCENES_API double rateOf(const TradeRow& row);

/// Runs the scene at a designed set of fidelities: first as it is, then one knob at a time, then several
/// together. A scene of many steps is represented by its first one, unless thorough. Which rows there are
/// depends on the clock; what a row holds does not, but for its times. Throws as assemble().
VPS_SCENES_API TradeResult trade(const Scene& scene, const TradeOptions& options = {});

/// The answers in words, one a line: "for 1000 Hz on this machine choose ...". What cannot be had is said.
/// Chosen from the rows that ran to the end and whose force is less than half off.
VPS_SCENES_API std::vector<std::string> tradeAnswers(const TradeResult& result);
/// Which knob buys what, against the scene's own setting, a line for each row.
VPS_SCENES_API std::vector<std::string> tradeKnobs(const TradeResult& result);

}  // namespace vps::scenes
