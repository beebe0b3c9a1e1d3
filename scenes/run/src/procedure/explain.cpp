// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/run/explain.h"

#include <algorithm>
#include <utility>

#include "core/machine.h"
#include "models/scene_models.h"
#include "simulation/simulation.h"
#include "world/placed_parts.h"

namespace vps::scenes {

namespace {

std::vector<PartCost> costOf(const Scene& scene, const ModelPlan& plan,
                             const std::vector<BuildTimes>& times) {
  std::vector<PartCost> costs(scene.parts.size());
  for (std::size_t i = 0; i < costs.size(); ++i) {
    if (plan.parts[i].same_as) continue;
    const PartModel* model = scene.parts[i].model.get();
    costs[i].map_wall_s = times[i].map_wall_s;
    costs[i].shell_wall_s = times[i].shell_wall_s;
    if (model != nullptr && model->map) costs[i].map_bytes = model->map->memoryBytes();
    if (model == nullptr || !model->shell) continue;
    costs[i].shell_bytes = model->shell->memoryBytes();
    costs[i].points = model->shell->size();
  }
  return costs;
}

void cookSteps(const Scene& scene, const ModelPlan& plan, const ModelOptions& options, ModelPlanCost& cost) {
  Simulation simulation(scene, plan);
  const CookedPoses poses(scene);
  const ModelledCost own = cost.most;
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    if (options.progress)
      options.progress("cooking for step " + std::to_string(s + 1),
                       static_cast<double>(s) / static_cast<double>(plan.steps.size()));
    StepCost& step = cost.steps.emplace_back();
    const std::vector<FixedPart> parts = poses.add(simulation.field().parts, plan.steps[s]);
    if (simulation.needsField(parts, plan.steps[s])) {
      CookedField field = cookField(simulation.orderField(parts, plan.steps[s]));
      step.is_cooked = true;
      step.cook_wall_s = field.wall_s;
      cost.cook_wall_s += field.wall_s;
      simulation.setField(std::move(field));
    }
    ModelledCost with_field = own;
    simulation.addField(with_field);
    step.bytes = with_field.bytes - own.bytes;
    step.points = with_field.field_points;
    if (with_field.bytes > cost.most.bytes) cost.most = with_field;
  }
}

}  // namespace

ExplainedModels explain(Scene scene, ModelPurpose purpose, const ModelOptions& options) {
  ExplainedModels explained;
  explained.plan = makeModelPlan(scene, purpose, options.models_everything);
  const double begun_s = wallSeconds();
  const std::vector<BuildTimes> times = buildModels(scene, explained.plan, options);
  explained.cost.build_wall_s = wallSeconds() - begun_s;
  explained.cost.parts = costOf(scene, explained.plan, times);
  explained.cost.most = modelledCost(scene);
  cookSteps(scene, explained.plan, options, explained.cost);
  return explained;
}

PartUse useOf(const ModelPlan& plan, std::size_t part, std::size_t step) {
  const FieldPlan& planned = plan.steps[step];
  if (std::ranges::count(planned.cooked, part) > 0) return PartUse::Cooked;
  if (std::ranges::count(planned.left_out, part) > 0) return PartUse::LeftOut;
  if (planned.part ? *planned.part == part : plan.parts[part].has_shell) return PartUse::Moves;
  return PartUse::Absent;
}

}  // namespace vps::scenes
