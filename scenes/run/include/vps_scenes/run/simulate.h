// SPDX-License-Identifier: BSD-3-Clause
// Simulates the scene's bodies under gravity, without a hand.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/model_options.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

struct BodyState {
  std::string name;
  Pose X_WP;
  Twist V_WP_W;  ///< velocity of the part's origin, in W
};

/// How deep two bodies overlap, by exact distance between their meshes.
struct PairOverlap {
  std::string a, b;
  double depth_m = 0;
  Vec3 at_W = Vec3::Zero();
  double time_s = 0;
};

/// Two bodies that overlapped at the start by more than the limit.
struct OverlappingStart {
  PairOverlap start;
  std::optional<double> apart_s;  ///< first time at which they overlapped by the limit or less; empty: never
  double end_depth_m = 0;         ///< overlap when the two bodies were judged last
};

struct JudgedOverlap {
  double limit_m = 0;
  std::size_t poses_judged = 0;
  /// Deepest overlap of all pairs, at the steps' poses and between them. A pair that overlapped at the start
  /// and has not come apart counts only where it is deeper than at the start by the limit or more. The part
  /// that moves is named first.
  PairOverlap deepest;
  std::vector<OverlappingStart> at_start;
  /// Number of pairs that have overlapped by more than the limit since the start.
  [[nodiscard]] std::size_t neverApart() const {
    std::size_t count = 0;
    for (const OverlappingStart& start : at_start) count += !start.apart_s;
    return count;
  }
  [[nodiscard]] bool isWithinLimit() const { return deepest.depth_m <= limit_m && neverApart() == 0; }
};

/// The deepest overlap of a run by exact distance, at the start, the end and along all steps.
struct JudgedDepth {
  PairOverlap deepest;       ///< depth 0: nothing overlapped
  double bound_m = 0;        ///< upper bound of the overlap at any time, also between the steps' poses
  std::size_t measures = 0;  ///< number of single pairs that were measured between start and end
  /// False: bound_m comes from an interval of time that was not searched, since the search would have taken
  /// too long. True: bound_m may still exceed the deepest overlap, by the overlap that is allowed to parts
  /// that start inside each other.
  bool is_searched = true;
};

struct SimulateOptions : ModelOptions {
  /// Measures the overlap of all pairs of bodies at the start, after every `judge_every` steps and at the
  /// end; 0: never. judge_every must be 0 if is_real_time is set.
  int judge_every = 0;
  /// Runs in real time: each step begins when it is due. The steps and their results stay the same.
  bool is_real_time = false;
  const std::atomic<bool>* stop = nullptr;  ///< set the flag to end the simulation early
  /// Called after every step; an empty function is not called.
  std::function<void(double time_s, const std::vector<BodyState>& bodies, double max_depth_m)> trace;
};

struct SimulateResult {
  std::vector<BodyState> bodies;
  /// Deepest overlap of the run: exact.deepest.depth_m.
  double max_penetration_m = 0;
  double contact_depth_m = 0;  ///< deepest contact of the run as the solver saw it
  JudgedDepth exact;  ///< exact overlaps, judged during the run, or after it if the run is in real time
  std::optional<JudgedOverlap> overlap;
  double kinetic_energy_J = 0;  ///< kinetic energy at the end of the run
  /// Number of times that bodies in contact were stopped within a step, because no contact force was found
  /// that keeps their sharp edges and corners apart for the whole step. Each stop of bodies within a step
  /// takes energy from them.
  std::size_t shortened_steps = 0;
  std::vector<FastTurn> fast_turns;  ///< one for each part that turned too fast for its steps
  int most_substeps = 1;             ///< greatest number of substeps of a step
  TickTimes step, contact_step;      ///< duration of all steps, and of the steps with contact
  ModelledCost modelled;
  double build_wall_s = 0;
  struct RealTime {
    std::uint64_t missed = 0;  ///< periods without a step of their own
    bool has_priority = false, has_locked_memory = false;
    std::vector<std::string> warnings;  ///< what the operating system refused
    double run_wall_s = 0;
  };
  std::optional<RealTime> real_time;  ///< timing of a run in real time; else empty
};

/// Names the part that needs the highest physics rate, with the remedy and the number of other parts that
/// turn too fast. The text is empty if no part turns too fast.
VPS_SCENES_API std::string inWords(const std::vector<FastTurn>& turns, const Fidelity& fidelity);

/// Every part that is not fixed is a dynamic body at its designed pose. The limit of overlap is 10 um, or a
/// quarter of the least clearance that a step states. Throws LoadError as assemble() does.
VPS_SCENES_API SimulateResult simulate(Scene& scene, double seconds, const SimulateOptions& options = {});

}  // namespace vps::scenes
