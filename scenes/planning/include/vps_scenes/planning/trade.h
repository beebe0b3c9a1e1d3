// SPDX-License-Identifier: BSD-3-Clause
// Measures speed against accuracy for a scene.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/model_options.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// The setting that a row changes, relative to the scene's own fidelity.
enum class TradeKnob {
  Own,  ///< the scene's own fidelity
  Voxel,
  Spacing,
  Sides,
  Gradient,
  Contact,
  ContactLimit,
  HapticRate,
  PhysicsRate,
  SolverIterations,
  Together,   ///< several settings
  Reference,  ///< all settings far finer than in the scene; the other runs are compared with this run
};
VPS_SCENES_API const char* toText(TradeKnob knob);

/// One fidelity to measure.
struct TradeSetting {
  std::string name;  ///< "voxel x2"
  TradeKnob knob = TradeKnob::Own;
  Fidelity fidelity;
};

/// Errors of the models at the probe's poses, against the exact surfaces of the meshes.
struct ProbeErrors {
  double distance_m = 0;     ///< worst error of the least distance (negative: depth), over all poses
  double penetration_m = 0;  ///< worst error of the depth, over the poses that penetrate
  double force = 0;          ///< median of |F - F_exact| / |F_exact|, over the poses that penetrate
  double torque = 0;         ///< as `force`, for the torque about the part's origin
};

/// Result of a run of the procedure.
struct TradeRun {
  bool completed = false;
  double deepest_m = 0;      ///< greatest depth by exact distance, over the steps
  double final_error_m = 0;  ///< worst distance of a part's origin from its designed target
  double peak_force_N = 0;   ///< peak force on the virtual hand
  double to_hand_J = 0, injected_J = 0;
  Vec3 p_W_end = Vec3::Zero();  ///< position of the last part's origin at rest
  std::size_t contacts_left_out = 0;
  std::size_t bytes = 0;  ///< memory of the models, with the cooked field
  double build_wall_s = 0, wall_s = 0;
  TickTimes physics, haptic;
};

/// Differences between a run and the reference run.
struct RunErrors {
  double final_m = 0, peak_force_N = 0, to_hand_J = 0;
};

struct TradeRow {
  TradeSetting setting;
  std::size_t points = 0, bytes = 0;
  bool has_probe = false, has_run = false, has_reference = false;
  ProbeErrors probe;
  double points_read = 0;       ///< mean number of points tested by a query, by the sides of the fidelity
  TickTimes query, all_points;  ///< time of a wrench query: with the tree of points, and testing all points
  double models_wall_s = 0;     ///< time to build the models that no earlier row had built
  TradeRun run;
  RunErrors off;
  /// True if no other row is as fast, as small in memory and as accurate, and better in speed, memory or
  /// accuracy.
  bool is_on_front = false;
};

struct TradeOptions : ModelOptions {
  double seconds = 45;       ///< limit of wall-clock time; the last run is cut at this limit
  bool is_thorough = false;  ///< all steps and all settings, without a time limit
  const std::atomic<bool>* stop = nullptr;
};

struct TradeResult {
  std::string scene;
  std::string excerpt;  ///< the part of the scene that was run: "step 1 of 9: bushing_lower"
  std::size_t poses = 0, poses_inside = 0;
  double reference_spacing_m = 0;  ///< spacing of the samples over which the exact wrench is summed
  std::vector<TradeRow> rows;
  std::vector<std::string> left_out;  ///< settings that were not measured, with the reason; one line for each
  std::vector<std::string> fixed;  ///< choices that a scene cannot make, with the reason; one line for each
};

/// Error of depth with a row's setting [m]: the larger of the worst model error at the probe's poses and the
/// deepest penetration in its run.
VPS_SCENES_API double errorOf(const TradeRow& row);
/// Physics rate [Hz] that the row's 99th percentile of processor time per step allows; 0 without a run.
VPS_SCENES_API double rateOf(const TradeRow& row);

/// Runs the scene at a set of fidelities: first at the scene's own fidelity, then with one setting changed at
/// a time, then with several settings changed together. A scene of many steps is represented by its first
/// step, unless is_thorough. Elapsed time decides which rows are measured, but affects no value in a row
/// apart from times. Throws as assemble().
VPS_SCENES_API TradeResult trade(const Scene& scene, const TradeOptions& options = {});

/// Recommendations, one on each line: "for 1000 Hz on this machine choose ...", or that no setting suffices.
/// Considers the rows that completed the run with a force error of at most one half.
VPS_SCENES_API std::vector<std::string> tradeAnswers(const TradeResult& result);
/// The effect of each changed setting relative to the scene's own fidelity, a line for each row.
VPS_SCENES_API std::vector<std::string> tradeKnobs(const TradeResult& result);

}  // namespace vps::scenes
