// SPDX-License-Identifier: BSD-3-Clause
#include "view/procedure_view.h"

#include "vps_scenes/scene/scene_parts.h"

namespace vps::viewer {
namespace {

Vec3 wayOut(const scenes::SceneStep& step) {
  const Pose& before = step.way_points.empty() ? step.X_WP_start : step.way_points.back();
  const Vec3 way = before.p - step.X_WP_target.p;
  return way.norm() > 0 ? Vec3(way.normalized()) : Vec3(Vec3::UnitZ());
}

}  // namespace

scenes::Snapshot exploded(const scenes::Scene& scene, scenes::Snapshot snapshot, double share,
                          double size_m) {
  if (!(share > 0)) return snapshot;
  const auto count = static_cast<double>(scene.steps.size());
  for (std::size_t i = 0; i < scene.steps.size(); ++i)
    for (scenes::BodySnapshot& body : snapshot.bodies)
      if (body.part == scene.steps[i].part)
        body.X_WP.p += share * size_m * (static_cast<double>(i) + 1) / count * wayOut(scene.steps[i]);
  snapshot.contacts.clear();
  snapshot.has_target = snapshot.has_hand = false;
  return snapshot;
}

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
