// SPDX-License-Identifier: BSD-3-Clause
#include "trade/probe.h"

#include <algorithm>
#include <limits>

#include "simulation/tick_times.h"
#include "vps/query.h"

namespace vps::scenes {

namespace {

constexpr int kRepeats = 5;

/// The penalty wrench of one pair, as a haptic loop computes it: on the moving part P about P's origin, in W.
ModelResponse queryPair(const PartModel& fixed, const Pose& X_WM, const PartModel& held, const Pose& X_WP,
                        const Fidelity& fidelity, bool is_exhaustive) {
  QueryOptions options;
  options.gradient = fidelity.gradient;
  options.is_exhaustive = is_exhaustive;
  const Pose X_MP = X_WM.inverse() * X_WP;
  TouchSummary sum;
  const QueryResult result =
      fidelity.sides == Sides::Both
          ? queryBothSides({fixed.map.get(), fixed.shell.get()}, {held.map.get(), held.shell.get()}, X_MP,
                           options, kProbeStiffness_N_per_m3, X_MP.p, sum)
          : queryWrench(*fixed.map, *held.shell, X_MP, options, kProbeStiffness_N_per_m3, X_MP.p, sum);
  ModelResponse response;
  response.points = result.points_tested;
  response.F_W.f = X_WM.R * sum.F_O_M.f;
  response.F_W.tau = X_WM.R * sum.F_O_M.tau;
  return response;
}

double leastOfPair(const PartModel& fixed, const Pose& X_WM, const PartModel& held, const Pose& X_WP,
                   Sides sides) {
  const Pose X_MP = X_WM.inverse() * X_WP;
  double least_m = queryDistance(*fixed.map, *held.shell, X_MP).min_distance_m;
  if (sides == Sides::Both)
    least_m = std::min(least_m, queryDistance(*held.map, *fixed.shell, X_MP.inverse()).min_distance_m);
  return least_m;
}

}  // namespace

ModelResponse queryModels(const Scene& scene, std::size_t moving, const Pose& X_WP, bool is_exhaustive) {
  ModelResponse all;
  for (const ScenePart& part : scene.parts) {
    if (!part.is_fixed) continue;
    const ModelResponse one =
        queryPair(*part.model, part.X_WP, *scene.parts[moving].model, X_WP, scene.fidelity, is_exhaustive);
    all.points += one.points;
    all.F_W.f += one.F_W.f;
    all.F_W.tau += one.F_W.tau;
  }
  return all;
}

double leastDistance(const Scene& scene, std::size_t moving, const Pose& X_WP) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const ScenePart& part : scene.parts)
    if (part.is_fixed)
      least_m = std::min(least_m, leastOfPair(*part.model, part.X_WP, *scene.parts[moving].model, X_WP,
                                              scene.fidelity.sides));
  return least_m;
}

TickTimes timeQueries(const Scene& scene, std::size_t moving, const std::vector<Pose>& poses,
                      bool is_exhaustive) {
  TickClock clock;
  for (int repeat = 0; repeat < kRepeats; ++repeat)
    for (const Pose& X_WP : poses) {
      clock.start();
      (void)queryModels(scene, moving, X_WP, is_exhaustive);
      clock.stop();
    }
  return clock.summary();
}

}  // namespace vps::scenes
