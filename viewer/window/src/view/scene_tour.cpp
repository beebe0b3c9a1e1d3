// SPDX-License-Identifier: BSD-3-Clause
// The timeline of a scene's planned procedure, without physics.
#include <algorithm>
#include <cmath>

#include "view/timeline.h"
#include "vps_device/operator.h"

namespace vps::viewer {
namespace {

constexpr double kFinished_s = 2, kMove_s = 1.5, kRest_s = 0.5;

/// The pose on the path after a share of the time; each leg takes the same time.
Pose onPath(const scenes::SceneStep& step, double share) {
  std::vector<Pose> path = {step.X_WP_start};
  path.insert(path.end(), step.way_points.begin(), step.way_points.end());
  path.push_back(step.X_WP_target);
  const double legs = share * static_cast<double>(path.size() - 1);
  const auto leg = std::min(static_cast<std::size_t>(legs), path.size() - 2);
  return interpolate(path[leg], path[leg + 1], legs - static_cast<double>(leg));
}

scenes::Snapshot finished(const scenes::Scene& scene) {
  scenes::Snapshot shot;
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    shot.bodies.push_back({i, scene.parts[i].X_WP, scenes::BodyRole::Mounted});
  for (const scenes::SceneStep& step : scene.steps) shot.bodies[step.part].X_WP = step.X_WP_target;
  return shot;
}

scenes::Snapshot tourAt(const scenes::Scene& scene, double time_s) {
  scenes::Snapshot shot = finished(scene);
  shot.time_s = time_s;
  const double since_s = time_s - kFinished_s;
  if (since_s < 0 || scene.steps.empty()) return shot;
  const auto now = std::min(static_cast<std::size_t>(since_s / (kMove_s + kRest_s)), scene.steps.size() - 1);
  for (std::size_t i = now + 1; i < scene.steps.size(); ++i)
    shot.bodies[scene.steps[i].part].role = scenes::BodyRole::Waiting;
  const scenes::SceneStep& step = scene.steps[now];
  const double share = (since_s - static_cast<double>(now) * (kMove_s + kRest_s)) / kMove_s;
  shot.step = static_cast<int>(now);
  shot.bodies[step.part] = {step.part, onPath(step, device::minimumJerk(std::min(1.0, share))),
                            scenes::BodyRole::InHand};
  shot.has_target = true;
  shot.target_part = step.part;
  shot.X_WP_target = step.X_WP_target;
  return shot;
}

}  // namespace

std::size_t Timeline::chapterAt(double t_s) const {
  std::size_t found = 0;
  for (std::size_t i = 0; i < chapters.size(); ++i)
    if (chapters[i].start_s <= t_s) found = i;
  return found;
}

Timeline sceneTour(const scenes::Scene& scene) {
  Timeline tour;
  tour.chapters.push_back({"finished assembly", 0, ""});
  for (std::size_t i = 0; i < scene.steps.size(); ++i)
    tour.chapters.push_back({std::to_string(i + 1) + " " + scene.parts[scene.steps[i].part].part.name,
                             kFinished_s + static_cast<double>(i) * (kMove_s + kRest_s), ""});
  tour.end_s = kFinished_s + static_cast<double>(scene.steps.size()) * (kMove_s + kRest_s);
  tour.at = [&scene, end_s = tour.end_s](double time_s) {
    return tourAt(scene, std::clamp(time_s, 0.0, end_s));
  };
  return tour;
}

}  // namespace vps::viewer
