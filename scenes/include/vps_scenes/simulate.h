// SPDX-License-Identifier: BSD-3-Clause
// The scene's bodies under gravity, no hand.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vps_scenes/model_options.h"
#include "vps_scenes/result.h"
#include "vps_scenes/scene.h"

namespace vps {

struct BodyState {
  std::string name;
  Pose X_WP;
  Twist V_WP_W;  ///< of the part's origin, in W
};

struct SimulateOptions : ModelOptions {
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
};

/// Every part that is not fixed is a dynamic body at its designed pose. Throws LoadError as assemble() does.
SimulateResult simulate(Scene& scene, double seconds, const SimulateOptions& options = {});

}  // namespace vps
