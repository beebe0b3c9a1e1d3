// SPDX-License-Identifier: BSD-3-Clause
#include "view/planned_path.h"

#include "vps_scenes/scene/part_mass.h"

namespace vps::viewer {

PlannedPath plannedPath(const scenes::Scene& scene, const scenes::Snapshot& shot) {
  PlannedPath path;
  if (shot.step < 0 || static_cast<std::size_t>(shot.step) >= scene.steps.size()) return path;
  const scenes::SceneStep& step = scene.steps[static_cast<std::size_t>(shot.step)];
  const Vec3 p_PG = scenes::partMass(scene.parts[step.part]).com;
  path.points_W.push_back(step.X_WP_start * p_PG);
  for (const Pose& X_WP : step.way_points) path.points_W.push_back(X_WP * p_PG);
  path.points_W.push_back(step.X_WP_target * p_PG);
  const Vec3 leg_W = path.points_W.back() - path.points_W[path.points_W.size() - 2];
  constexpr double kLeast_m = 1e-9;
  if (leg_W.norm() > kLeast_m) path.axis_W = leg_W.normalized();
  return path;
}

}  // namespace vps::viewer
