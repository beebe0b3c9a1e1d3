// SPDX-License-Identifier: BSD-3-Clause
#include "study/varied_scene.h"

#include <algorithm>
#include <limits>

#include "models/shrunk_mesh.h"
#include "scene/insertion_axis.h"

namespace vps::scenes {

namespace {

/// Applies a change to every pose of the step's part, from start to target.
template <class Change>
void changePath(SceneStep& step, Change change) {
  change(step.X_WP_start);
  for (Pose& X_WP : step.way_points) change(X_WP);
  change(step.X_WP_target);
}

/// A part in place, as drawn and with its deviation.
struct Placed {
  Pose X_WP_drawn, X_WP;
  double growth_m = 0, turn_rad = 0;
};

/// Rise of the highest of these parts near a point, against the axis, compared with the drawing. A tilt lifts
/// a part of this radius at one edge.
double seatRise(const std::vector<Placed>& in_place, const Vec3& p_W, const Vec3& axis_W, double radius_m) {
  if (in_place.empty() || axis_W.isZero()) return 0;
  double rise_m = -std::numeric_limits<double>::infinity();
  for (const Placed& part : in_place) {
    const Vec3 move_W = part.X_WP * (part.X_WP_drawn.inverse() * p_W) - p_W;
    rise_m = std::max(rise_m, part.growth_m + part.turn_rad * radius_m - move_W.dot(axis_W));
  }
  return rise_m;
}

}  // namespace

void growPart(ScenePart& part, double by_m) {
  if (by_m == 0) return;
  part.part.mesh = shrunkMesh(part.part.mesh, -by_m);
  part.model.reset();
  part.is_cropped = false;
}

Scene withGrownStep(const Scene& scene, std::size_t step, double by_m) {
  Scene grown = scene;
  SceneStep& of = grown.steps[step];
  growPart(grown.parts[of.part], by_m);
  const Vec3 back_W = -by_m * insertionAxis(of, Pose());
  changePath(of, [&](Pose& X_WP) { X_WP.p += back_W; });
  return grown;
}

Pose PartDeviation::X_PE() const {
  return {rotationFromVector(turn_P_rad), move_P_m};
}

Scene withDeviations(const Scene& scene, const std::vector<PartDeviation>& deviations) {
  Scene varied = scene;
  std::vector<Placed> in_place;
  for (std::size_t i = 0; i < varied.parts.size(); ++i) {
    ScenePart& part = varied.parts[i];
    const PartDeviation& by = deviations[i];
    growPart(part, by.growth_m);
    part.part.material.friction = std::max(0.0, part.part.material.friction + by.friction);
    if (!part.is_fixed) continue;
    const Pose X_WP_drawn = part.X_WP;
    if (by.isDisplaced()) part.X_WP = part.X_WP * by.X_PE();
    in_place.push_back({X_WP_drawn, part.X_WP, by.growth_m, by.turn_P_rad.norm()});
  }
  for (SceneStep& step : varied.steps) {
    const PartDeviation& by = deviations[step.part];
    const Vec3 axis_W = insertionAxis(step, Pose());
    const double radius_m = 0.5 * bounds(scene.parts[step.part].part.mesh).size().norm();
    const Pose X_WP_drawn = step.X_WP_target;
    const double rise_m =
        by.growth_m + by.turn_P_rad.norm() * radius_m + seatRise(in_place, X_WP_drawn.p, axis_W, radius_m);
    const Vec3 across_m = X_WP_drawn.R * by.move_P_m;
    const Vec3 move_W = across_m - across_m.dot(axis_W) * axis_W - rise_m * axis_W;
    changePath(step, [&](Pose& X_WP) {
      if (!by.turn_P_rad.isZero()) X_WP.R = X_WP.R * rotationFromVector(by.turn_P_rad);
      X_WP.p += move_W;
    });
    in_place.push_back({X_WP_drawn, step.X_WP_target, by.growth_m, by.turn_P_rad.norm()});
  }
  return varied;
}

}  // namespace vps::scenes
