// SPDX-License-Identifier: BSD-3-Clause
// estimate(): the figures that explain() measures, estimated from areas and edges alone.

#include <cmath>
#include <optional>
#include <utility>

#include "models/scene_models.h"
#include "vps/box.h"
#include "vps/mesh_repair.h"
#include "vps/model_estimate.h"
#include "vps/stoppable.h"
#include "vps_scenes/run/explain.h"
#include "world/placed_parts.h"

namespace vps::scenes {

namespace {

std::size_t rounded(double value) {
  return static_cast<std::size_t>(std::llround(value));
}

bool isModelled(const PartModelPlan& part) {
  return part.has_map || part.has_shell;
}

class Estimator {
 public:
  Estimator(const Scene& scene, ModelPurpose purpose, const ModelOptions& options) : scene_(scene) {
    out_.plan = makeModelPlan(scene, purpose, options.models_everything);
    out_.cost.is_estimated = true;
    out_.cost.parts.resize(scene.parts.size());
    estimates_.resize(scene.parts.size());
  }

  ExplainedModels run() && {
    const auto isCooked = [&](std::size_t i) {
      return std::ranges::any_of(
          out_.plan.steps, [i](const FieldPlan& step) { return std::ranges::count(step.cooked, i) > 0; });
    };
    for (const ScenePart& part : scene_.parts) requireUsable(part.part.mesh, part.file, part.part.name);
    // Only estimates of cropped models need pieces of the surface; the pieces of 10,000 parts take 3 GB.
    const bool is_cropped =
        std::ranges::any_of(out_.plan.parts,
                            [](const PartModelPlan& part) { return !part.kept_P.empty(); }) ||
        std::ranges::any_of(out_.plan.steps, [](const FieldPlan& step) { return step.region_W.has_value(); });
    const auto extent = is_cropped ? ModelEstimate::Extent::Any : ModelEstimate::Extent::WholeOnly;
    onAllCores(scene_.parts.size(), [&](std::size_t i) {
      const PartModelPlan& planned = out_.plan.parts[i];
      if (planned.same_as || !(isModelled(planned) || isCooked(i))) return;
      const Fidelity fidelity = fidelityOf(scene_.parts[i], scene_.fidelity);
      estimates_[i].emplace(scene_.parts[i].part.mesh, voxMapSettings(fidelity), pointShellSettings(fidelity),
                            extent);
    });
    for (std::size_t i = 0; i < scene_.parts.size(); ++i) addPart(i);
    own_ = out_.cost.most;
    const CookedPoses poses(scene_);
    for (const FieldPlan& step : out_.plan.steps) addStep(poses, step);
    return std::move(out_);
  }

 private:
  [[nodiscard]] const ModelEstimate& of(std::size_t part) const {
    return *estimates_[out_.plan.parts[part].same_as.value_or(part)];
  }

  void addPart(std::size_t i) {
    const PartModelPlan& planned = out_.plan.parts[i];
    if (planned.same_as || !isModelled(planned)) return;
    PartCost& cost = out_.cost.parts[i];
    ModelledCost& all = out_.cost.most;
    if (planned.has_map) {
      cost.map_bytes = rounded(of(i).mapBytes(planned.kept_P));
      ++all.voxmaps;
    }
    if (planned.has_shell) {
      cost.points = rounded(of(i).pointCount(planned.kept_P));
      cost.shell_bytes = rounded(ModelEstimate::shellBytes(static_cast<double>(cost.points)));
      ++all.pointshells;
    }
    all.points += cost.points;
    all.bytes += cost.map_bytes + cost.shell_bytes;
  }

  /// True if the field in place does not serve the step; decides as Simulation::needsField().
  [[nodiscard]] bool needsField(const std::vector<FixedPart>& parts, const FieldPlan& step) const {
    if (parts.size() != in_place_.size()) return true;
    if (parts.empty() || !region_W_) return false;
    return !step.region_W || !isWithin(*step.region_W, *region_W_);
  }

  void addStep(const CookedPoses& poses, const FieldPlan& step) {
    std::vector<FixedPart> parts = poses.add(in_place_, step);
    StepCost cost;
    cost.is_cooked = needsField(parts, step);
    if (cost.is_cooked) {
      in_place_ = std::move(parts);
      region_W_ = step.region_W;
      cookField(step);
    }
    cost.bytes = field_bytes_;
    cost.points = field_points_;
    out_.cost.steps.push_back(cost);
    ModelledCost& most = out_.cost.most;
    if (in_place_.empty() || own_.bytes + field_bytes_ <= most.bytes) return;
    most = own_;
    most.bytes += field_bytes_;
    most.voxmaps += 1;
    most.pointshells += step.has_shell ? 1 : 0;
    most.field_points = field_points_;
  }

  /// Estimates the field in place. The field's points lie in the region. The field's map contains the maps of
  /// the parts, except for the first part's map, which is shared if that part's frame is W.
  void cookField(const FieldPlan& step) {
    double map_bytes = 0, points = 0;
    for (std::size_t k = 0; k < in_place_.size(); ++k) {
      const auto& [part, X_WP] = in_place_[k];
      const bool is_shared =
          k == 0 && !out_.plan.models_everything && X_WP.R.isIdentity(0) && X_WP.p.isZero(0);
      if (!is_shared) map_bytes += of(part).mapBytes(out_.plan.parts[part].kept_P);
      if (!step.has_shell) continue;
      std::vector<Box> within_P;
      if (region_W_) within_P.push_back(moved(*region_W_, X_WP.inverse()));
      points += of(part).pointCount(within_P);
    }
    field_points_ = rounded(points);
    field_bytes_ = rounded(map_bytes + (step.has_shell ? ModelEstimate::shellBytes(points) : 0));
  }

  const Scene& scene_;
  ExplainedModels out_;
  std::vector<std::optional<ModelEstimate>>
      estimates_;                    ///< by part; empty for a part that shares the models of another part
  std::vector<FixedPart> in_place_;  ///< parts of the field
  std::optional<Box> region_W_;
  std::size_t field_bytes_ = 0, field_points_ = 0;
  ModelledCost own_;  ///< cost of the parts alone
};

}  // namespace

ExplainedModels estimate(const Scene& scene, ModelPurpose purpose, const ModelOptions& options) {
  return Estimator(scene, purpose, options).run();
}

}  // namespace vps::scenes
