// SPDX-License-Identifier: BSD-3-Clause
#include "scene/steps.h"

#include <algorithm>
#include <limits>

#include "vps/box.h"

namespace vps::scenes {

Vec3 insertionAxis(const SceneStep& step, const Pose& X_PG) {
  constexpr double kLeast_m = 1e-9;
  const auto& way = step.way_points;
  const Pose& X_from = step.takes_off || way.empty() ? step.X_WP_start : way.back();
  const Pose& X_to = !step.takes_off || way.empty() ? step.X_WP_target : way.front();
  const Vec3 leg_W = X_to * X_PG.p - X_from * X_PG.p;
  return leg_W.norm() < kLeast_m ? Vec3(Vec3::Zero()) : Vec3(leg_W.normalized());
}

std::vector<PartInPlace> partsInPlace(const Scene& scene, std::size_t before_step) {
  std::vector<PartInPlace> parts;
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    if (scene.parts[i].is_fixed) parts.push_back({i, scene.parts[i].X_WP});
  const auto add = [&](const SceneStep& step) { parts.push_back({step.part, placeOf(step)}); };
  for (std::size_t i = scene.steps.size(); i-- > before_step + 1;)
    if (scene.steps[i].takes_off) add(scene.steps[i]);
  for (std::size_t i = 0; i < before_step; ++i)
    if (!scene.steps[i].takes_off) add(scene.steps[i]);
  return parts;
}

SmallestPart smallestMoved(const Scene& scene) {
  SmallestPart out{"", std::numeric_limits<double>::infinity()};
  const auto add = [&](const Part& part) {
    const double across_m = bounds(part.mesh).size().minCoeff();
    if (across_m < out.across_m) out = {part.name, across_m};
  };
  for (const SceneStep& step : scene.steps) add(scene.parts[step.part].part);
  if (scene.steps.empty())
    for (const ScenePart& part : scene.parts)
      if (!part.is_fixed) add(part.part);
  return out;
}

double usualSpacing_m(const Scene& scene) {
  const double voxel_m = scene.fidelity.voxel_m;
  if (scene.fidelity.contact_method == ContactMethod::Penalty) return 2 * voxel_m;
  constexpr double kShare = 0.25;
  return std::clamp(kShare * smallestMoved(scene).across_m, 2 * voxel_m, 4 * voxel_m);
}

}  // namespace vps::scenes
