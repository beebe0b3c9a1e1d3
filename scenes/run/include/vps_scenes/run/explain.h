// SPDX-License-Identifier: BSD-3-Clause
// The cost of a model plan in memory and time, without running anything: estimated, or measured by building
// its models and cooking its fields.
#pragma once

#include "vps_scenes/export.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/model_options.h"
#include "vps_scenes/scene/model_plan.h"

namespace vps::scenes {

/// Cost of one part's own models; 0 if the part has none or shares those of another part.
struct PartCost {
  std::size_t map_bytes = 0, shell_bytes = 0, points = 0;
  /// Wall time to build the model or to read it from the cache; 0 in an estimate.
  double map_wall_s = 0, shell_wall_s = 0;
};

/// Cost of the fixed field of one step, without the models that it shares with its parts.
struct StepCost {
  std::size_t bytes = 0, points = 0;
  bool is_cooked = false;  ///< false: the field of the previous step also serves this step
  double cook_wall_s = 0;
};

struct ModelPlanCost {
  std::vector<PartCost> parts;
  std::vector<StepCost> steps;
  ModelledCost most;  ///< the parts' models and the largest field
  double build_wall_s = 0, cook_wall_s = 0;
  bool is_estimated = false;  ///< estimated from areas and edges: nothing was built, and times are 0
};

struct ExplainedModels {
  ModelPlan plan;
  ModelPlanCost cost;
};

/// Builds the plan's models, and cooks each step's field with the parts of earlier steps at their targets.
/// (In a run, the parts of earlier steps lie where contact left them.) Throws LoadError as assemble().
VPS_SCENES_API ExplainedModels explain(Scene scene, ModelPurpose purpose, const ModelOptions& options);

/// The results of explain(), estimated from areas and edges (vps/model_estimate.h): bytes and counts are
/// rough, and times are not known. O(triangles), in parallel. Throws LoadError for a mesh that cannot be
/// modelled.
VPS_SCENES_API ExplainedModels estimate(const Scene& scene, ModelPurpose purpose,
                                        const ModelOptions& options);

/// Role of a part in a step.
enum class PartUse {
  Absent,   ///< not yet in place, or only drawn
  Moves,    ///< in the hand, or free
  Cooked,   ///< in the fixed field
  LeftOut,  ///< in place, but out of the moving part's reach
};
VPS_SCENES_API PartUse useOf(const ModelPlan& plan, std::size_t part, std::size_t step);

}  // namespace vps::scenes
