// SPDX-License-Identifier: BSD-3-Clause
// What blocks a step by geometry alone: at its target, as drawn, the part overlaps what is in place by then.
#pragma once

#include <vector>

#include "vps/progress.h"
#include "vps_scenes/result.h"
#include "vps_scenes/scene.h"

namespace vps::scenes::inline v0 {

/// Results with the deepest such overlap of each step, beyond the error of the meshes; blocked_by is empty
/// where there is none, or where the scene allows it. Exact distances on all cores.
std::vector<StepResult> blocksAtTargets(const Scene& scene, const Progress& progress);

}  // namespace vps::scenes::inline v0
