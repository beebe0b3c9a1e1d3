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
/// The parts of a scene: those that a step mounts at the target of their last step, others at their pose.
VPS_SCENES_API std::vector<DrawnPart> drawnParts(const Scene& scene);

/// Measures the parts as they stand, on all cores. The same bits on any number of threads. Throws LoadError
/// for parts without a surface, and of sizes at which the answers would mean nothing (below 10 um, above
/// 1 km).
VPS_SCENES_API CheckResult checkAssembly(const std::string& name, const std::vector<DrawnPart>& parts,
                                         const CheckSettings& settings = {}, const Progress& progress = {});

}  // namespace vps::scenes
