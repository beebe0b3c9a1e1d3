// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/uses/ergonomics.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "vps/mesh.h"
#include "vps_scenes/scene/scene_parts.h"

namespace vps::scenes {

namespace {

/// A position of the hand, and the time that the hand spends there.
struct HandPlace {
  Vec3 p_W = Vec3::Zero();
  double time_s = 0;
};

bool isUpright(const Scene& scene) {
  const Vec3& g = scene.gravity_W;
  return g.head<2>().norm() <= 1e-6 * std::abs(g.z()) && g.z() <= 0;
}

/// Positions of the hand for each step. The hand grasps the part at its centre of mass.
std::vector<std::vector<HandPlace>> placesOf(const Scene& scene, const std::vector<TraceRow>& trace) {
  std::vector<std::vector<HandPlace>> of_step(scene.steps.size());
  std::vector<Vec3> com_P;
  for (const SceneStep& step : scene.steps) com_P.push_back(partMass(scene.parts[step.part]).com);
  for (std::size_t i = 0; i < trace.size(); ++i) {
    const TraceRow& row = trace[i];
    if (row.step < 0 || static_cast<std::size_t>(row.step) >= of_step.size()) continue;
    if (row.phase == static_cast<int>(TracePhase::Rest)) continue;
    const auto step = static_cast<std::size_t>(row.step);
    const double before_s = i == 0 ? row.time_s : trace[i - 1].time_s;
    of_step[step].push_back({row.X_WP * com_P[step], std::max(0.0, row.time_s - before_s)});
  }
  return of_step;
}

/// Bounding boxes of all parts in place, without and with the path of the hand.
struct Surroundings {
  Box parts_W, all_W;
};

Surroundings surroundingsOf(const Scene& scene, const std::vector<std::vector<HandPlace>>& places) {
  Surroundings found;
  std::vector<Pose> X_WP;
  for (const ScenePart& part : scene.parts) X_WP.push_back(part.X_WP);
  for (const SceneStep& step : scene.steps) X_WP[step.part] = placeOf(step);
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    if (scene.parts[i].is_scenery) continue;
    const Box box = bounds(transformed(scene.parts[i].part.mesh, X_WP[i]));
    for (Box* of : {&found.parts_W, &found.all_W}) {
      of->add(box.min);
      of->add(box.max);
    }
  }
  for (const auto& step : places)
    for (const HandPlace& place : step) found.all_W.add(place.p_W);
  return found;
}

StepErgonomics measured(const Body& body, const std::vector<HandPlace>& places, const Vec3& p_WS) {
  StepErgonomics of;
  of.elbow_least_rad = std::numeric_limits<double>::infinity();
  double time_s = 0, out_s = 0, rula_s = 0;
  for (const HandPlace& place : places) {
    const ArmPose arm = armTo(body, place.p_W - p_WS);
    const int rula = arm.is_reached ? rulaArm(arm) : kWorstRula;
    of.greatest_reach = std::max(of.greatest_reach, arm.reach_share);
    of.raised_rad = std::max(of.raised_rad, arm.raised_rad);
    of.elbow_least_rad = std::min(of.elbow_least_rad, arm.elbow_rad);
    of.elbow_most_rad = std::max(of.elbow_most_rad, arm.elbow_rad);
    of.rula_worst = std::max(of.rula_worst, rula);
    time_s += place.time_s;
    out_s += arm.is_reached ? 0 : place.time_s;
    rula_s += rula * place.time_s;
  }
  of.out_of_reach_share = time_s > 0 ? out_s / time_s : (of.greatest_reach > 1 ? 1 : 0);
  of.rula_mean = time_s > 0 ? rula_s / time_s : of.rula_worst;
  return of;
}

bool isBetter(const StepErgonomics& a, const StepErgonomics& b) {
  if (a.out_of_reach_share != b.out_of_reach_share) return a.out_of_reach_share < b.out_of_reach_share;
  if (a.rula_mean != b.rula_mean) return a.rula_mean < b.rula_mean;
  return a.greatest_reach < b.greatest_reach;
}

}  // namespace

Ergonomics measureErgonomics(const Scene& scene, const std::vector<TraceRow>& trace) {
  Ergonomics result;
  if (!isUpright(scene)) return result;
  const auto places = placesOf(scene, trace);
  const Surroundings around = surroundingsOf(scene, places);
  result.p_WB =
      Vec3(around.parts_W.center().x(), around.all_W.min.y() - kToShoulder_m, around.parts_W.min.z());
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].empty()) continue;
    for (const Body& body : assumedBodies())
      for (const Posture posture : {Posture::Seated, Posture::Standing}) {
        const double bench_m = posture == Posture::Seated ? kSeatedBench_m : kStandingBench_m;
        const Vec3 middle_W = result.p_WB + Vec3(0, 0, body.shoulderHeight_m(posture) - bench_m);
        StepErgonomics right = measured(body, places[i], middle_W + Vec3(body.shoulderAside_m(), 0, 0));
        StepErgonomics left = measured(body, places[i], middle_W - Vec3(body.shoulderAside_m(), 0, 0));
        right.hand = "right";
        left.hand = "left";
        StepErgonomics& better = isBetter(left, right) ? left : right;
        better.part = scene.parts[scene.steps[i].part].part.name;
        better.body = body.name;
        better.posture = posture;
        result.steps.push_back(std::move(better));
      }
  }
  return result;
}

}  // namespace vps::scenes
