// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scaled_scene.h"

#include <algorithm>
#include <cmath>

#include "models/meeting_sizes.h"

namespace vps::scenes {

namespace {

Pose scaled(const Pose& X, double factor) {
  return Pose(X.R, Vec3(factor * X.p));
}

PairOverlap scaledBack(PairOverlap overlap, double factor) {
  overlap.depth_m /= factor;
  overlap.at_W /= factor;
  return overlap;
}

JudgedDepth scaledBack(JudgedDepth judged, double factor) {
  judged.deepest = scaledBack(judged.deepest, factor);
  judged.bound_m /= factor;
  return judged;
}

JudgedOverlap scaledBack(JudgedOverlap judged, double factor) {
  judged.limit_m /= factor;
  judged.deepest = scaledBack(judged.deepest, factor);
  for (OverlappingStart& start : judged.at_start) {
    start.start = scaledBack(start.start, factor);
    start.end_depth_m /= factor;
  }
  return judged;
}

}  // namespace

double simulationScale(const Scene& scene) {
  double least_m = kLeastAcross_m;
  for (const ScenePart& part : scene.parts)
    if (!part.is_fixed) least_m = std::min(least_m, across_m(part.part.mesh));
  if (!(least_m > 0) || least_m >= kLeastAcross_m) return 1;
  return std::exp2(std::ceil(std::log2(kLeastAcross_m / least_m)));
}

Scene scaledScene(const Scene& scene, double factor) {
  Scene larger = scene;
  larger.gravity_W *= factor;
  larger.fidelity.voxel_m *= factor;
  larger.fidelity.spacing_m *= factor;
  for (ScenePart& part : larger.parts) {
    for (Vec3& p_P : part.part.mesh.vertices) p_P *= factor;
    part.X_WP = scaled(part.X_WP, factor);
    part.V_WP_W.v *= factor;
    part.press_fit_m *= factor;
    part.voxel_m *= factor;
    part.spacing_m *= factor;
    // Stiffness is pressure per depth. Forces scale with the fourth power of the factor, areas with the
    // square.
    part.part.material.stiffness_N_per_m3 *= factor;
    part.model.reset();
    part.is_cropped = false;
  }
  for (SceneStep& step : larger.steps) {
    step.X_WP_start = scaled(step.X_WP_start, factor);
    step.X_WP_target = scaled(step.X_WP_target, factor);
    for (Pose& X_WP : step.way_points) X_WP = scaled(X_WP, factor);
    step.clearance_m *= factor;
  }
  return larger;
}

std::vector<BodyState> scaledBack(std::vector<BodyState> bodies, double factor) {
  for (BodyState& body : bodies) {
    body.X_WP = scaled(body.X_WP, 1 / factor);
    body.V_WP_W.v /= factor;
  }
  return bodies;
}

SimulateResult scaledBack(SimulateResult result, double factor) {
  result.bodies = scaledBack(std::move(result.bodies), factor);
  result.max_penetration_m /= factor;
  result.contact_depth_m /= factor;
  result.exact = scaledBack(result.exact, factor);
  if (result.overlap) result.overlap = scaledBack(*result.overlap, factor);
  result.kinetic_energy_J /= std::pow(factor, 5);  // energy is a mass times the square of a velocity
  return result;
}

}  // namespace vps::scenes
