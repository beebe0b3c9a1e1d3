// SPDX-License-Identifier: BSD-3-Clause
#include "world/placed_parts.h"

#include <algorithm>
#include <cmath>

#include "models/scene_models.h"
#include "vps/box.h"

namespace vps::scenes {

PlacedParts::PlacedParts(Scene& scene, ModelPlan& plan, Simulation& simulation, const ModelOptions& options)
    : scene_(scene),
      plan_(plan),
      simulation_(simulation),
      options_(options),
      judged_(scene.parts.size()),
      modelled_(modelledCost(scene)) {}

void PlacedParts::addToJudge(std::size_t part) {
  const auto placed = std::ranges::find(placed_, part, &FixedPart::part);
  if (scene_.parts[part].model && scene_.parts[part].model->shell)
    judge_.mount(judgedBody(part), placed->X_WP);
}

void PlacedParts::leaveOut(std::size_t part) {
  std::erase_if(placed_, [part](const FixedPart& placed) { return placed.part == part; });
}

void PlacedParts::renewJudge() {
  judge_ = OverlapJudge();
  for (const FixedPart& placed : placed_) addToJudge(placed.part);
}

const JudgedBody& PlacedParts::judgedBody(std::size_t part) {
  std::optional<JudgedBody>& body = judged_[part];
  if (!body) body = makeJudgedBody(scene_.parts[part].model);
  return *body;
}

std::optional<FieldOrder> PlacedParts::orderFor(std::size_t step) {
  return orderFor(step, false);
}

std::optional<FieldOrder> PlacedParts::orderFor(std::size_t step, bool rebuilds) {
  const bool is_past_last = step >= plan_.steps.size();
  if (is_past_last && !plan_.models_everything) return {};
  const FieldPlan& planned = plan_.steps[std::min(step, plan_.steps.size() - 1)];
  std::vector<FixedPart> parts = simulation_.field().parts;
  const auto has_left = [this](const FixedPart& part) {
    return std::ranges::find(placed_, part.part, &FixedPart::part) == placed_.end();
  };
  const bool shrinks = std::erase_if(parts, has_left) > 0;
  for (const FixedPart& placed : placed_) {
    if (std::ranges::find(parts, placed.part, &FixedPart::part) != parts.end()) continue;
    const Box box_W = moved(bounds(scene_.parts[placed.part].part.mesh), placed.X_WP);
    if (!planned.region_W || overlap(box_W, *planned.region_W)) parts.push_back(placed);
  }
  if (!simulation_.needsField(parts, planned)) return {};
  return simulation_.orderField(parts, planned, shrinks || rebuilds);
}

void PlacedParts::setField(CookedField field) {
  if (!field.shape) return simulation_.clearField();
  simulation_.setField(std::move(field));
  ModelledCost cost = modelledCost(scene_);
  simulation_.addField(cost);
  if (cost.bytes > modelled_.bytes) modelled_ = cost;
}

bool PlacedParts::isCovered(std::size_t step, const Box& box_P, const Pose& X_WP, const Twist& V_W,
                            double dt_s) const {
  const std::optional<Box>& region_W = plan_.steps[step].region_W;
  if (!region_W || placed_.empty()) return true;
  const VoxMapSettings map = voxMapSettings(scene_.fidelity);
  const double farthest_m = box_P.size().norm() + box_P.center().norm();
  const double speed_m_s = V_W.v.norm() + V_W.w.norm() * farthest_m;
  // The factor of 2 allows for acceleration within the step.
  const double reach_m = map.band_voxels * map.voxel_m + 2 * speed_m_s * dt_s;
  return isWithin(grown(moved(box_P, X_WP), reach_m), *region_W);
}

std::vector<std::size_t> PlacedParts::widenTo(std::size_t step, const Box& region_W) {
  std::vector<std::size_t> changed;
  for (const FixedPart& placed : placed_) {
    if (!scene_.parts[placed.part].is_fixed) continue;  // parts that are not fixed are modelled everywhere
    PartModelPlan& part = plan_.parts[placed.part];
    const bool is_whole = part.has_map && part.kept_P.empty();
    if (is_whole || !overlap(moved(bounds(scene_.parts[placed.part].part.mesh), placed.X_WP), region_W))
      continue;
    part.has_map = part.has_shell = true;
    part.kept_P.push_back(moved(region_W, placed.X_WP.inverse()));
    judged_[placed.part].reset();
    changed.push_back(placed.part);
  }
  plan_.steps[step].region_W = region_W;
  plan_.steps[step].has_shell = true;
  std::ranges::sort(changed);
  return changed;
}

void PlacedParts::widen(std::size_t step, const Box& box_P, const Pose& X_WP) {
  constexpr int kMostInStep = 4;  // with four regions, a falling part may move by 15 times its size
  ++widened_;
  widened_in_step_ = widened_step_ == step ? widened_in_step_ + 1 : 1;
  widened_step_ = step;
  ModelOptions options;
  options.cache = options_.cache;  // but no progress and warnings, which the caller received at loading
  bool has_changed = true;
  if (widened_in_step_ > kMostInStep) {
    buildWhole(scene_, plan_, options);
    for (const FixedPart& placed : placed_)
      if (scene_.parts[placed.part].is_fixed) judged_[placed.part].reset();
  } else {
    const double band_m = voxMapSettings(scene_.fidelity).band_voxels * scene_.fidelity.voxel_m;
    const double by_m = std::ldexp(box_P.size().norm() + 2 * band_m, widened_in_step_ - 1);
    Box region_W = grown(moved(box_P, X_WP), by_m);
    region_W.add(plan_.steps[step].region_W->min);
    region_W.add(plan_.steps[step].region_W->max);
    const std::vector<std::size_t> changed = widenTo(step, region_W);
    has_changed = !changed.empty();
    if (has_changed) buildModels(scene_, plan_, changed, options);
  }
  if (has_changed) renewJudge();
  if (const auto order = orderFor(step, has_changed)) setField(cookField(*order));
}

}  // namespace vps::scenes
