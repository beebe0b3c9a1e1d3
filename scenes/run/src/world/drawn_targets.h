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

/// A result for each step with tolerance_m, aligned_by, mesh_doubt and press_needed_N. If geometry proves
/// that the part cannot reach its target, verdict, reason and blocked_... are set too: at its target the part
/// overlaps a part in place by more than the error of the meshes (and the scene does not allow it), or its
/// start or target lies in a cavity without an opening. Uses exact distances, on all cores.
/// @param checked  receives the check that the results come from; null: not wanted
std::vector<StepResult> checkDrawnTargets(const Scene& scene, const Progress& progress,
                                          std::shared_ptr<const CheckResult>* checked = nullptr);

}  // namespace vps::scenes
