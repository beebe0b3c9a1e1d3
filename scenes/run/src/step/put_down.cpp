// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/run/put_down.h"

#include <algorithm>

#include "vps/box.h"
#include "vps_scenes/run/assemble_options.h"

namespace vps::scenes {
namespace {

/// Moves `box` along x until it overlaps none of the others, at least by a tenth of its length.
double wayAside_m(const Box& box, const std::vector<Box>& others) {
  double way_m = 0;
  const auto at = [&](double x_m) {
    return Box{box.min + x_m * Vec3::UnitX(), box.max + x_m * Vec3::UnitX()};
  };
  for (std::size_t tries = 0; tries <= others.size(); ++tries) {
    const auto hit =
        std::ranges::find_if(others, [&](const Box& other) { return overlap(at(way_m), other); });
    if (hit == others.end()) return way_m;
    way_m = hit->max.x() - box.min.x() + 0.1 * box.size().x();
  }
  return way_m;
}

}  // namespace

Scene sceneFromStep(const Scene& scene, std::size_t first, std::span<const PutDown> before) {
  Scene left = scene;
  left.steps.erase(left.steps.begin(), left.steps.begin() + static_cast<std::ptrdiff_t>(first));
  left.hand.seed += first;
  for (const PutDown& put : before) {
    const auto moves = [&put](const SceneStep& step) { return step.part == put.part; };
    left.parts[put.part].X_WP = put.X_WP;
    left.parts[put.part].is_fixed = std::ranges::none_of(left.steps, moves);
  }
  return left;
}

std::vector<Pose> laidOut(const Scene& scene) {
  std::vector<Pose> X_WP;
  for (const ScenePart& part : scene.parts) X_WP.push_back(part.X_WP);
  std::vector<bool> has_step(scene.parts.size(), false);
  for (const SceneStep& step : scene.steps) has_step[step.part] = true;
  std::vector<Box> taken;
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    if (!has_step[i] && !scene.parts[i].is_scenery)
      taken.push_back(moved(bounds(scene.parts[i].part.mesh), X_WP[i]));
  for (const SceneStep& step : scene.steps) {
    if (!has_step[step.part]) continue;  // laid out already, by an earlier step
    has_step[step.part] = false;
    X_WP[step.part] = step.X_WP_start;
    const Box box_W = moved(bounds(scene.parts[step.part].part.mesh), step.X_WP_start);
    const Vec3 aside_W = wayAside_m(box_W, taken) * Vec3::UnitX();
    X_WP[step.part].p += aside_W;
    taken.push_back({box_W.min + aside_W, box_W.max + aside_W});
  }
  return X_WP;
}

Scene sceneOfOnePart(const Scene& scene, std::span<const Pose> X_WP, std::size_t part) {
  Scene free = scene;
  SceneStep only;
  only.part = part;
  only.X_WP_target = scene.parts[part].X_WP;
  for (const SceneStep& step : scene.steps)
    if (step.part == part) only.X_WP_target = step.X_WP_target;
  only.X_WP_start = X_WP[part];
  only.tolerance_m = 1e-12;  // so that it is never taken to have arrived
  only.timeout_s = 1e3 * kPersonTimeout_s;
  only.is_held = true;
  free.steps = {only};
  for (std::size_t i = 0; i < free.parts.size(); ++i) {
    free.parts[i].X_WP = X_WP[i];
    free.parts[i].is_fixed = i != part && !free.parts[i].is_scenery;
  }
  free.parts[part].allow_overlap = true;  // it may lie pressed against another
  free.parts[part].is_scenery = false;
  return free;
}

}  // namespace vps::scenes
