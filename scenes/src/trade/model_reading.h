// SPDX-License-Identifier: BSD-3-Clause
// What a scene's models say of the part that moves at a pose, and how long they take to say it.
#pragma once

#include <cstddef>
#include <vector>

#include "vps/wrench.h"
#include "vps_scenes/result.h"
#include "vps_scenes/scene.h"

namespace vps::scenes {

struct Reading {
  Wrench F_W;  ///< penalty wrench on the moving part about its origin, at kProbeStiffness_N_per_m3
  std::size_t points = 0;  ///< looked at, both sides
};

/// Reads all fixed parts as a haptic loop would; their wrenches add up. `moving` is a part's index.
Reading readAll(const Scene& scene, std::size_t moving, const Pose& X_WP, bool is_exhaustive);

/// Least signed distance to any fixed part [m]; negative is depth. By the points of the sides that the
/// scene's fidelity asks.
double leastDistance(const Scene& scene, std::size_t moving, const Pose& X_WP);

/// Of a pose, five times over all of them.
TickTimes timeQueries(const Scene& scene, std::size_t moving, const std::vector<Pose>& poses,
                      bool is_exhaustive);

}  // namespace vps::scenes
