// SPDX-License-Identifier: BSD-3-Clause
#include "view/exploded.h"

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

}  // namespace vps::viewer
