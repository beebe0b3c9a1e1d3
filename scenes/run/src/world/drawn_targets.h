// SPDX-License-Identifier: BSD-3-Clause
// Results of the drawing for each step: which part blocks the step's part, and how exactly the part is held
// at its target.
#pragma once

#include <memory>
#include <vector>

#include "vps/errors.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// A result for each step with tolerance_m, aligned_by, mesh_doubt and press_needed_N. If a part overlaps
/// another one at its target by more than the error of the meshes (and the scene does not allow it), the
/// places near by decide (CheckedPlaces): the part's path and target in `scene` are moved to a place without
/// overlap (moved_m); or it is proven that there is none, and verdict, reason and blocked_... are set; or
/// neither, and overlap_doubt is set. blocked_... are set too for a part whose start or target lies in a
/// cavity without an opening. Uses exact distances, on all cores.
/// @param checked  receives the check of the scene as drawn; null: not wanted
std::vector<StepResult> checkDrawnTargets(Scene& scene, const Progress& progress,
                                          std::shared_ptr<const CheckResult>* checked = nullptr);

}  // namespace vps::scenes
