// SPDX-License-Identifier: BSD-3-Clause
// What the drawing alone says of each step: what blocks its part, and how exactly the part is held where it
// belongs.
#pragma once

#include <memory>
#include <vector>

#include "vps/errors.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// A result for each step with tolerance_m, aligned_by, mesh_doubt and press_needed_N, and with reason and
/// blocked_... where geometry proves that the part cannot be there: at its target it overlaps what is in
/// place by then, by more than the error of the meshes (and the scene does not allow it), or it starts or
/// ends in a room without a way in. Exact distances, on all cores.
/// @param checked  receives what the steps' results were made from; may be null
std::vector<StepResult> checkDrawnTargets(const Scene& scene, const Progress& progress,
                                          std::shared_ptr<const CheckResult>* checked = nullptr);

}  // namespace vps::scenes
