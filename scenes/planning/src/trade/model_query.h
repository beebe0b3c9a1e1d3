// SPDX-License-Identifier: BSD-3-Clause
// Queries the models of a scene for the moved part, and times the queries.
#pragma once

#include <cstddef>
#include <vector>

#include "vps/wrench.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Contact of one part with all fixed parts, computed from the models.
struct ModelResponse {
  Wrench F_W;  ///< penalty wrench on the moving part about its origin, at kProbeStiffness_N_per_m3
  std::size_t points = 0;  ///< number of points tested, both sides
};

/// Queries all fixed parts as a haptic loop would, and sums their wrenches. `moving` is the index of the
/// moved part.
ModelResponse queryModels(const Scene& scene, std::size_t moving, const Pose& X_WP, bool is_exhaustive);

/// Least signed distance to any fixed part [m]; negative is depth. Uses the points of one or both sides, as
/// set in the scene's fidelity.
double leastDistance(const Scene& scene, std::size_t moving, const Pose& X_WP);

/// Time of one query, over the given poses; each pose is measured five times.
TickTimes timeQueries(const Scene& scene, std::size_t moving, const std::vector<Pose>& poses,
                      bool is_exhaustive);

}  // namespace vps::scenes
