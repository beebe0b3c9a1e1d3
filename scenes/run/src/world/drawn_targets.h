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
/// another one at its target by more than the error of the meshes (and the scene does not allow it), and
/// CheckedPlaces has a place near by without overlap, the part's path and target in `scene` are moved there
/// (moved_m). Otherwise verdict, reason and blocked_... are set, and overlap_doubt if it is not proven that
/// there is no such place. blocked_... are set too for a part whose start or target lies in a cavity without
/// an opening. Uses exact distances, on all cores.
/// @param checked  receives the check of the scene as drawn; null: not wanted
std::vector<StepResult> checkDrawnTargets(Scene& scene, const Progress& progress,
                                          std::shared_ptr<const CheckResult>* checked = nullptr);

/// The tolerance of each step's part at its target [m], as checkDrawnTargets() states it. Searches for no
/// places and decides nothing about overlaps.
std::vector<double> drawnTolerances_m(const Scene& scene);

}  // namespace vps::scenes
