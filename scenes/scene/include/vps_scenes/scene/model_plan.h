// SPDX-License-Identifier: BSD-3-Clause
// Plans which parts of a scene get which models, and in which region. The plan follows from geometry alone,
// before any model is built.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// The use of the models.
enum class ModelPurpose {
  Assemble,  ///< one part moves at a time, along its step's path, and a judge measures this part against all
             ///< others
  Simulate,  ///< all parts that are not fixed move, in unlimited regions
};

/// The planned models of one part, in the part's frame.
struct PartModelPlan {
  bool has_map = false, has_shell = false;
  std::optional<std::size_t> same_as;  ///< an earlier part of equal geometry, whose models the part shares
  /// Boxes, in the part's frame, in which a fixed part's models are kept; empty: everywhere.
  std::vector<Box> kept_P;
  std::string why;  ///< reason for the part's models, in words
};

/// The parts that are merged ("cooked") into the fixed field while one step's part moves.
struct FieldPlan {
  std::optional<std::size_t> part;  ///< the part that moves; none: all parts that are not fixed
  std::optional<Box> region_W;      ///< region in which the part moves; none: unlimited
  std::vector<std::size_t> cooked, left_out;
  bool has_shell = true;  ///< the field has points, which are tested against the moving part
  std::string why;
};

struct ModelPlan {
  ModelPurpose purpose = ModelPurpose::Assemble;
  bool models_everything = false;
  std::vector<PartModelPlan> parts;  ///< one for each part of the scene
  std::vector<FieldPlan> steps;      ///< one for each step of the scene; a single plan for Simulate
};

/// Makes the plan of a scene. A part's region is the box of its start, way points and target, enlarged by the
/// map's band and by the error of the hand: 4 standard deviations of the aim in position and angle, and 0.5
/// mm (assumed). The region is an estimate that saves memory and time: when a part comes near the border of
/// its region, the run models a larger region (assemble.h).
/// @param models_everything  builds a map and a shell for each part; no part shares models or is left out
VPS_SCENES_API ModelPlan makeModelPlan(const Scene& scene, ModelPurpose purpose,
                                       bool models_everything = false);
/// A plan with complete models of every part for Assemble; parts of equal geometry share models.
VPS_SCENES_API ModelPlan makeSharedModelPlan(const Scene& scene);

}  // namespace vps::scenes
