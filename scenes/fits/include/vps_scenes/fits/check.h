// SPDX-License-Identifier: BSD-3-Clause
// Exact measures of an assembly as drawn, without a hand: overlap and clearance of its parts, fits, play.
#pragma once

#include <string>
#include <vector>

#include "vps/errors.h"
#include "vps_scenes/cad/import.h"
#include "vps_scenes/export.h"
#include "vps_scenes/fits/check_types.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// The parts of a CAD file at their poses.
VPS_SCENES_API std::vector<DrawnPart> drawnParts(const ImportedCad& cad);
/// The parts of a scene. A part that a step mounts is at the target of its last step, any other part at its
/// pose.
VPS_SCENES_API std::vector<DrawnPart> drawnParts(const Scene& scene);

/// Measures the parts at their poses, on all cores. The result has the same bits on any number of threads.
/// Throws LoadError for a part without a surface, and for a part that is too small or too large to be
/// measured (below 10 um, above 1 km).
VPS_SCENES_API CheckResult checkAssembly(const std::string& name, const std::vector<DrawnPart>& parts,
                                         const CheckSettings& settings = {}, const Progress& progress = {});

}  // namespace vps::scenes
