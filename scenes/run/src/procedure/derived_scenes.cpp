// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/run/derived_scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "scene/steps.h"
#include "vps/box.h"
#include "vps/errors.h"
#include "vps/mesh_repair.h"
#include "vps_device/operator.h"
#include "vps_scenes/run/assemble_options.h"

namespace vps::scenes {

namespace {

/// Distance along x at which `box` overlaps none of `others`, with a gap of a tenth of the length of `box`.
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

/// Rotation from one way point to the next way point: far below half a turn, whose direction would be
/// ambiguous.
constexpr double kUnscrewTurn_rad = 0.5 * std::numbers::pi;
/// Time limit of unscrewing as a multiple of the time that the turns take. assumed: re-grasping takes as long
/// as turning, with a margin
constexpr double kSpareTime = 3;

/// The path out of a thread, from the target to the start of the last leg.
std::vector<Pose> unscrewed(const SceneStep& step, const Pose& X_PG) {
  const Vec3 axis_W = insertionAxis(step, X_PG), target_W = step.X_WP_target * X_PG.p;
  const Pose& X_before = step.way_points.empty() ? step.X_WP_start : step.way_points.back();
  const double way_m = (target_W - X_before * X_PG.p).norm();
  const double turn_rad = 2 * std::numbers::pi * way_m / step.pitch_m;
  const int count = std::max(1, static_cast<int>(std::ceil(std::abs(turn_rad) / kUnscrewTurn_rad)));
  std::vector<Pose> poses;
  for (int i = 1; i <= count; ++i) {
    const double share = static_cast<double>(i) / count;
    const Mat3 R = rotationFromVector(-share * turn_rad * axis_W) * step.X_WP_target.R;
    poses.emplace_back(R, Vec3(target_W - share * way_m * axis_W - R * X_PG.p));
  }
  return poses;
}

/// The poses before the last leg in reverse order: the way points, then the start.
std::vector<Pose> restOfTheWay(const SceneStep& step) {
  std::vector<Pose> poses{step.X_WP_start};
  poses.insert(poses.end(), step.way_points.begin(), step.way_points.end());
  std::ranges::reverse(poses);
  return poses;
}

/// The whole path of a screw that is taken off. Beyond the thread the part keeps the rotation with which it
/// left the thread.
std::vector<Pose> wayOutOfThread(const SceneStep& step, const Pose& X_PG) {
  std::vector<Pose> way = unscrewed(step, X_PG);
  const Mat3 turn = way.back().R * step.X_WP_target.R.transpose();
  const std::vector<Pose> rest = restOfTheWay(step);
  for (std::size_t i = 1; i < rest.size(); ++i) {  // the first pose is where the thread ends
    const Mat3 R = turn * rest[i].R;
    way.emplace_back(R, Vec3(rest[i] * X_PG.p - R * X_PG.p));
  }
  return way;
}

SceneStep takenOff(const SceneStep& step, const Mesh& mesh) {
  const Pose X_PG = Pose::translation(solidMass(mesh).com);
  const bool is_screw = step.motion == StepMotion::Screw && step.pitch_m != 0;
  std::vector<Pose> way = is_screw ? wayOutOfThread(step, X_PG) : restOfTheWay(step);
  SceneStep off;
  off.part = step.part;
  off.takes_off = true;
  off.is_held = true;  // something holds the part where it was put away
  off.X_WP_start = step.X_WP_target;
  off.X_WP_target = way.back();
  way.pop_back();
  off.way_points = std::move(way);
  off.clearance_m = step.clearance_m;
  off.tolerance_m = std::min(kAway_m, 0.25 * (off.X_WP_target * X_PG.p - off.X_WP_start * X_PG.p).norm());
  off.timeout_s = step.timeout_s;
  if (is_screw)
    off.timeout_s += kSpareTime * kUnscrewTurn_rad / device::OperatorHabits{}.turn_rad_s *
                     static_cast<double>(off.way_points.size());
  return off;
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
    if (!has_step[step.part]) continue;  // an earlier step of the same part has laid it out
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
  only.tolerance_m = 1e-12;  // so small that the part never counts as arrived
  only.timeout_s = 1e3 * kPersonTimeout_s;
  only.is_held = true;
  free.steps = {only};
  for (std::size_t i = 0; i < free.parts.size(); ++i) {
    free.parts[i].X_WP = X_WP[i];
    free.parts[i].is_fixed = i != part && !free.parts[i].is_scenery;
  }
  free.parts[part].allow_overlap = true;  // the part may lie pressed against another one
  free.parts[part].is_scenery = false;
  return free;
}

Scene disassemblyOf(Scene scene) {
  if (scene.steps.empty())
    throw LoadError(scene.file, "",
                    "has no [[step]], so there is no path along which a part could be taken off");
  if (std::ranges::any_of(scene.steps, &SceneStep::takes_off))
    throw LoadError(scene.file, "", "is a disassembly already");
  if (std::ranges::none_of(scene.parts, &ScenePart::is_fixed))
    throw LoadError(scene.file, "",
                    "has no fixed part from which the others could be taken; set fixed = true in the "
                    "[[part]] that does not move");
  std::vector<SceneStep> steps;
  for (const SceneStep& step : scene.steps) steps.push_back(takenOff(step, scene.parts[step.part].part.mesh));
  std::ranges::reverse(steps);
  scene.steps = std::move(steps);
  return scene;
}

}  // namespace vps::scenes
