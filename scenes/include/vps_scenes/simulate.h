// SPDX-License-Identifier: BSD-3-Clause
// The scene's bodies under gravity, no hand.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/model_options.h"
#include "vps_scenes/result.h"
#include "vps_scenes/scene.h"

namespace vps::scenes {

struct BodyState {
  std::string name;
  Pose X_WP;
  Twist V_WP_W;  ///< of the part's origin, in W
};

struct SimulateOptions : ModelOptions {
  /// By the system's clock: a step begins when it is due. Steps are the same, and so is what comes of them.
  bool is_real_time = false;
  const std::atomic<bool>* stop = nullptr;  ///< set it to end early
  /// Called after every step; empty: no trace.
  std::function<void(double time_s, const std::vector<BodyState>& bodies, double max_depth_m)> trace;
};

struct SimulateResult {
  std::vector<BodyState> bodies;
  double max_penetration_m = 0;  ///< deepest contact of the run, by the voxmaps
  double kinetic_energy_J = 0;   ///< at the end
  TickTimes step, contact_step;  ///< all steps; those with contact
  ModelledCost modelled;
  double build_wall_s = 0;
  /// By the clock: what the system refused, and periods that passed without a step of their own.
  struct Kept {
    std::uint64_t missed = 0;
    bool has_priority = false, has_locked_memory = false;
    std::vector<std::string> warnings;
    double run_wall_s = 0;
  };
  std::optional<Kept> real_time;
};

/// Every part that is not fixed is a dynamic body at its designed pose. Throws LoadError as assemble() does.
VPS_SCENES_API SimulateResult simulate(Scene& scene, double seconds, const SimulateOptions& options = {});

}  // namespace vps::scenes
