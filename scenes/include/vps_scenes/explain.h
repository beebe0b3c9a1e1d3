// SPDX-License-Identifier: BSD-3-Clause
// What a plan costs: its models built and its fields cooked, without running anything.
#pragma once

#include "vps_scenes/export.h"
#include "vps_scenes/model_options.h"
#include "vps_scenes/plan.h"
#include "vps_scenes/result.h"

namespace vps::scenes {

struct PartCost {
  std::size_t map_bytes = 0, shell_bytes = 0, points = 0;  ///< 0 where it has none, or shares another's
  double map_wall_s = 0, shell_wall_s = 0;                 ///< to build, or to take from the cache
};

/// Of the fixed field that a step needs, beside the parts' own models.
struct StepCost {
  std::size_t bytes = 0, points = 0;
  bool is_cooked = false;  ///< false: the one before will do
  double cook_wall_s = 0;
};

struct PlanCost {
  std::vector<PartCost> parts;
  std::vector<StepCost> steps;
  ModelledCost most;  ///< own models and the largest field
  double build_wall_s = 0, cook_wall_s = 0;
};

struct ExplainedPlan {
  Plan plan;
  PlanCost cost;
};

/// Builds what the plan says, and cooks each step's field with all parts of earlier steps on their targets. A
/// run does so too, but for where contact leaves a part. Throws LoadError as assemble().
VPS_SCENES_API ExplainedPlan explain(Scene scene, PlanFor purpose, const ModelOptions& options);

/// What becomes of a part in a step.
enum class PartUse { Absent, Moves, Cooked, LeftOut };
VPS_SCENES_API PartUse useOf(const Plan& plan, std::size_t part, std::size_t step);

}  // namespace vps::scenes
