// SPDX-License-Identifier: BSD-3-Clause
// What of a scene is modelled, for whom, where, and why: decided from geometry alone before anything is
// built.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/scene.h"

namespace vps::scenes {

enum class PlanFor {
  Assemble,  ///< one part moves at a time, along its step's path, and a judge measures it against all others
  Simulate,  ///< all that is not fixed moves, and may go anywhere
};

/// A part's own models, in its own frame.
struct PlannedPart {
  bool has_map = false, has_shell = false;
  std::optional<std::size_t> same_as;  ///< an earlier part of equal geometry, whose models it shares
  /// Where a fixed part's models are kept, in its frame; empty: all over.
  std::vector<Box> kept_P;
  std::string why;  ///< in words for a person
};

/// What is cooked into the fixed field while something moves.
struct PlannedStep {
  std::optional<std::size_t> part;  ///< what moves; none: all that is not fixed
  std::optional<Box> region_W;      ///< where it may come; none: anywhere
  std::vector<std::size_t> cooked, left_out;
  bool has_shell = true;  ///< of the field: its points against the moving part
  std::string why;
};

struct Plan {
  PlanFor purpose = PlanFor::Assemble;
  bool models_everything = false;
  std::vector<PlannedPart> parts;  ///< as the scene's
  std::vector<PlannedStep> steps;  ///< as the scene's; one to simulate
};

/// A part's region is the box of its start, way points and target, grown by the map's band and by what the
/// hand may miss: 4 standard deviations of aim and turn, and 0.5 mm (assumed). It is a guess, and only saves:
/// a run whose part comes near its border models the rest then (assemble.h).
/// @param models_everything  no sparing: a map and a shell for each part, none shared, nothing left out
VPS_SCENES_API Plan makePlan(const Scene& scene, PlanFor purpose, bool models_everything = false);
/// Everything to assemble with, but equal geometry once: models that any question can be put to.
VPS_SCENES_API Plan makeSharingPlan(const Scene& scene);

}  // namespace vps::scenes
