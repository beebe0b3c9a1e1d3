// SPDX-License-Identifier: BSD-3-Clause
// Queries the models of a scene for the part that moves, and times the queries.
#pragma once

#include <cstddef>
#include <vector>

#include "vps/wrench.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Contact of one part with all fixed parts, by the models.
struct ModelResponse {
  Wrench F_W;  ///< penalty wrench on the moving part about its origin, at kProbeStiffness_N_per_m3
  std::size_t points = 0;  ///< tested, both sides
};

/// Queries all fixed parts as a haptic loop would and adds their wrenches up. `moving` is a part's index.
ModelResponse queryModels(const Scene& scene, std::size_t moving, const Pose& X_WP, bool is_exhaustive);

/// Least signed distance to any fixed part [m]; negative is depth. By the points of one or both sides, as the
/// scene's fidelity says.
double leastDistance(const Scene& scene, std::size_t moving, const Pose& X_WP);

/// Time of the query at one pose; each pose is measured five times.
TickTimes timeQueries(const Scene& scene, std::size_t moving, const std::vector<Pose>& poses,
                      bool is_exhaustive);

}  // namespace vps::scenes
