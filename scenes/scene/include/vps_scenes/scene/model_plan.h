// SPDX-License-Identifier: BSD-3-Clause
// Which parts of a scene get which models, for what use and over which region. Decided from geometry alone,
// before anything is built.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// What the models are for.
enum class ModelPurpose {
  Assemble,  ///< one part moves at a time, along its step's path, and a judge measures it against all others
  Simulate,  ///< all parts that are not fixed move, and may go anywhere
};

/// The models of one part, in its own frame.
struct PartModelPlan {
  bool has_map = false, has_shell = false;
  std::optional<std::size_t> same_as;  ///< an earlier part of equal geometry, whose models it shares
  /// Boxes, in the part's frame, in which a fixed part's models are kept; empty: everywhere.
  std::vector<Box> kept_P;
  std::string why;  ///< the reason, for a person
};

/// What is cooked into the fixed field while one step's part moves.
struct FieldPlan {
  std::optional<std::size_t> part;  ///< the part that moves; none: all that are not fixed
  std::optional<Box> region_W;      ///< where it is expected; none: anywhere
  std::vector<std::size_t> cooked, left_out;
  bool has_shell = true;  ///< the field has points, which are tested against the moving part
  std::string why;
};

struct ModelPlan {
  ModelPurpose purpose = ModelPurpose::Assemble;
  bool models_everything = false;
  std::vector<PartModelPlan> parts;  ///< one for each part of the scene
  std::vector<FieldPlan> steps;      ///< one for each step of the scene; a single one for Simulate
};

/// A part's region is the box of its start, way points and target, grown by the map's band and by the error
/// of the hand: 4 standard deviations of its aim in position and angle, and 0.5 mm (assumed). The region is
/// only an estimate that saves memory and time: a run whose part comes near the border models more then
/// (assemble.h).
/// @param models_everything  a map and a shell for each part, none shared and nothing left out
VPS_SCENES_API ModelPlan makeModelPlan(const Scene& scene, ModelPurpose purpose,
                                       bool models_everything = false);
/// Whole models of every part for Assemble, with equal geometry built once.
VPS_SCENES_API ModelPlan makeSharedModelPlan(const Scene& scene);

}  // namespace vps::scenes
