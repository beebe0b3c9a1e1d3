// SPDX-License-Identifier: BSD-3-Clause
// Simulates the scene's bodies under gravity, without a hand.
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

namespace vps::scenes::inline v0 {

struct BodyState {
  std::string name;
  Pose X_WP;
  Twist V_WP_W;  ///< of the part's origin, in W
};

struct SimulateOptions : ModelOptions {
  /// By the system's clock: each step begins when it is due. The steps and their results stay the same.
  bool is_real_time = false;
  const std::atomic<bool>* stop = nullptr;  ///< set it to end early
  /// Called after every step. May be empty.
  std::function<void(double time_s, const std::vector<BodyState>& bodies, double max_depth_m)> trace;
};

struct SimulateResult {
  std::vector<BodyState> bodies;
  double max_penetration_m = 0;  ///< deepest contact of the run, by the voxmaps
  double kinetic_energy_J = 0;   ///< at the end
  TickTimes step, contact_step;  ///< of all steps; of those with contact
  ModelledCost modelled;
  double build_wall_s = 0;
  struct RealTime {
    std::uint64_t missed = 0;  ///< periods without a step of their own
    bool has_priority = false, has_locked_memory = false;
    std::vector<std::string> warnings;  ///< what the system refused
    double run_wall_s = 0;
  };
  std::optional<RealTime> real_time;  ///< of a run in real time
};

/// Every part that is not fixed is a dynamic body at its designed pose. Throws LoadError as assemble() does.
VPS_SCENES_API SimulateResult simulate(Scene& scene, double seconds, const SimulateOptions& options = {});

}  // namespace vps::scenes::inline v0
