// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/scene/model_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/equal_meshes.h"
#include "models/scene_models.h"
#include "scene/steps.h"
#include "vps/box.h"

namespace vps::scenes {

namespace {

constexpr double kDeviations = 4;        // standard deviations of the aim: exceeded in 6 of 100,000 steps
constexpr double kPeakOverMean = 1.875;  // peak speed / mean speed of a minimum-jerk motion
constexpr double kSpare_m = 0.5e-3;      // assumed: spring deflection and curvature of the path
/// One-sided queries use the points of the smaller body. Below this ratio of their sizes both bodies get
/// points, because the bridge compares boxes along other axes.
constexpr double kClearlySmaller = 2;

double margin_m(const Scene& scene, const Box& part) {
  const OperatorSettings& hand = scene.hand;
  const VoxMapSettings map = voxMapSettings(scene.fidelity);
  // PlacedParts::isCovered() requires this distance ahead of the part at the peak speed of a motion.
  const double ahead_m = 2 * kPeakOverMean * hand.speed_m_s / scene.fidelity.physics_rate_hz;
  return map.band_voxels * map.voxel_m + kSpare_m + ahead_m +
         kDeviations * (hand.aim_error_m + hand.aim_error_rad * 0.5 * part.size().norm());
}

/// Adds the boxes of a screw to `path`; on the last leg, the screw may have any rotation about its axis.
void addTurned(const SceneStep& step, const Box& part, Box& path) {
  constexpr int kTurns =
      8;  // rotations by 45 degrees; between two rotations a box protrudes by less than the region's margin
  const Vec3 center_P = part.center();
  const Vec3 axis_W = insertionAxis(step, Pose::translation(center_P));
  if (axis_W.isZero()) return;
  for (int i = 0; i < kTurns; ++i) {
    const Mat3 turn = rotationFromVector(2 * std::numbers::pi * i / kTurns * axis_W);
    for (const Pose& X_WP : {step.X_WP_start, step.X_WP_target}) {
      const Mat3 R = turn * X_WP.R;
      const Box at = moved(part, Pose(R, Vec3(X_WP * center_P - R * center_P)));
      path.add(at.min);
      path.add(at.max);
    }
  }
}

Box pathOf(const SceneStep& step, const Box& part) {
  Box path;
  const auto add = [&](const Pose& X_WP) {
    const Box at = moved(part, X_WP);
    path.add(at.min);
    path.add(at.max);
  };
  add(step.X_WP_start);
  for (const Pose& X_WP : step.way_points) add(X_WP);
  add(step.X_WP_target);
  if (step.motion == StepMotion::Screw) addTurned(step, part, path);
  return path;
}

/// Makes the plan of one scene.
class Planner {
 public:
  Planner(const Scene& scene, ModelPurpose purpose) : scene_(scene) {
    plan_.purpose = purpose;
    plan_.parts.resize(scene.parts.size());
    for (const ScenePart& part : scene.parts) boxes_.push_back(bounds(part.part.mesh));
  }

  ModelPlan everything() {
    planEverything();
    return std::move(plan_);
  }

  ModelPlan sharing() {
    planEverything();
    shareEqual();
    return std::move(plan_);
  }

  ModelPlan reduced() {
    planSteps(true);
    for (std::size_t i = 0; i < plan_.parts.size(); ++i) planPart(i);
    shareEqual();
    return std::move(plan_);
  }

 private:
  [[nodiscard]] bool isAssembly() const { return plan_.purpose == ModelPurpose::Assemble; }

  void planEverything() {
    plan_.models_everything = true;
    for (PartModelPlan& part : plan_.parts) part = {true, true, {}, {}, "everything is modelled"};
    planSteps(false);
  }

  void planSteps(bool is_reduced) {
    if (!isAssembly()) return planSimulation();
    for (std::size_t s = 0; s < scene_.steps.size(); ++s) {
      const SceneStep& step = scene_.steps[s];
      FieldPlan& planned = plan_.steps.emplace_back();
      planned.part = step.part;
      if (is_reduced)
        planned.region_W = grown(pathOf(step, boxes_[step.part]), margin_m(scene_, boxes_[step.part]));
      for (const auto& [i, X_WP] : partsInPlace(scene_, s)) {
        const bool is_near = !planned.region_W || overlap(moved(boxes_[i], X_WP), *planned.region_W);
        (is_near ? planned.cooked : planned.left_out).push_back(i);
      }
      planned.has_shell = !is_reduced || needsFieldShell(step.part, planned.cooked);
      planned.why =
          planned.has_shell ? "" : "one-sided: the moving part is the smaller body, so its points are used";
    }
  }

  void planSimulation() {
    FieldPlan& planned = plan_.steps.emplace_back();
    bool has_moving = false;
    for (const ScenePart& part : scene_.parts) has_moving = has_moving || !part.is_fixed;
    for (std::size_t i = 0; i < scene_.parts.size(); ++i)
      if (scene_.parts[i].is_fixed)
        (has_moving || plan_.models_everything ? planned.cooked : planned.left_out).push_back(i);
    if (plan_.models_everything) return;
    planned.has_shell = false;
    for (std::size_t i = 0; i < scene_.parts.size(); ++i)
      if (!scene_.parts[i].is_fixed) planned.has_shell |= needsFieldShell(i, planned.cooked);
  }

  /// True if points of the fixed field are ever tested against this part's map.
  [[nodiscard]] bool needsFieldShell(std::size_t part, const std::vector<std::size_t>& cooked) const {
    if (scene_.fidelity.sides == Sides::Both) return true;
    double fixed_m = 0;
    for (const std::size_t i : cooked) fixed_m = std::max(fixed_m, boxes_[i].size().norm());
    return fixed_m < kClearlySmaller * boxes_[part].size().norm();
  }

  void planPart(std::size_t i) {
    PartModelPlan& part = plan_.parts[i];
    if (!isAssembly()) return planFree(i, part);
    if (scene_.parts[i].is_fixed) return planFixed(i, part);
    for (std::size_t s = 0; s < scene_.steps.size(); ++s) {
      if (scene_.steps[s].part != i) continue;
      part.has_map = part.has_shell = true;
      part.why = scene_.steps[s].takes_off
                     ? "in place until step " + std::to_string(s + 1) + " takes the part off"
                     : "moves in step " + std::to_string(s + 1) + servesLater(i, s);
      return;
    }
    part.why = "no step moves the part and it is not fixed: nothing can touch the part, so it is only drawn";
  }

  /// The later steps for which a mounted part is cooked, in words.
  [[nodiscard]] std::string servesLater(std::size_t i, std::size_t moved_in) const {
    std::string steps;
    for (std::size_t s = moved_in + 1; s < plan_.steps.size(); ++s)
      if (std::ranges::count(plan_.steps[s].cooked, i) > 0)
        steps += (steps.empty() ? "" : ", ") + std::to_string(s + 1);
    return steps.empty() ? "; no later step comes near the part, so it is never cooked"
                         : "; then cooked, for step " + steps;
  }

  void planFixed(std::size_t i, PartModelPlan& part) {
    const Pose X_PW = scene_.parts[i].X_WP.inverse();
    for (const FieldPlan& step : plan_.steps)
      if (std::ranges::count(step.cooked, i) > 0) part.kept_P.push_back(moved(*step.region_W, X_PW));
    part.has_map = part.has_shell = !part.kept_P.empty();
    part.why = part.has_map ? "fixed: cooked in the region where a moving part may come"
                            : "fixed, but no moving part comes near: nothing can touch the part";
  }

  void planFree(std::size_t i, PartModelPlan& part) {
    const FieldPlan& all = plan_.steps.front();
    if (scene_.parts[i].is_fixed) {
      const bool is_cooked = std::ranges::count(all.cooked, i) > 0;
      part.has_shell = is_cooked && all.has_shell;
      part.why =
          is_cooked ? "fixed: only in the cooked field" : "no part moves, so nothing can touch this part";
      return;
    }
    std::size_t others = 0;
    for (std::size_t j = 0; j < scene_.parts.size(); ++j) others += j != i && !scene_.parts[j].is_fixed;
    part.has_shell = true;
    part.has_map = others > 0 || all.has_shell;
    part.why =
        part.has_map ? "moves freely" : "moves freely, one-sided: only the points of this part are tested";
  }

  void shareEqual() {
    EqualMeshes known;
    for (std::size_t i = 0; i < plan_.parts.size(); ++i) {
      if (!plan_.parts[i].has_map && !plan_.parts[i].has_shell) continue;
      const ScenePart& part = scene_.parts[i];
      const std::size_t equal = known.findOrAdd(i, part.part.mesh, [&](std::size_t j) {
        const ScenePart& other = scene_.parts[j];
        return part.press_fit_m == other.press_fit_m && part.voxel_m == other.voxel_m &&
               part.spacing_m == other.spacing_m && isEqualGeometry(part.part.mesh, other.part.mesh);
      });
      if (equal != EqualMeshes::kNone) share(i, equal);
    }
  }

  void share(std::size_t i, std::size_t j) {
    PartModelPlan &a = plan_.parts[j], &b = plan_.parts[i];
    a.has_map = b.has_map = a.has_map || b.has_map;
    a.has_shell = b.has_shell = a.has_shell || b.has_shell;
    a.kept_P.clear();  // models are kept everywhere, because one of the two parts may move
    b.kept_P.clear();
    b.same_as = j;
  }

  const Scene& scene_;
  ModelPlan plan_;
  std::vector<Box> boxes_;  ///< bounding boxes of the parts, each in the part's frame
};

}  // namespace

ModelPlan makeSharedModelPlan(const Scene& scene) {
  return Planner(scene, ModelPurpose::Assemble).sharing();
}

ModelPlan makeModelPlan(const Scene& scene, ModelPurpose purpose, bool models_everything) {
  Planner planner(scene, purpose);
  return models_everything ? planner.everything() : planner.reduced();
}

}  // namespace vps::scenes
