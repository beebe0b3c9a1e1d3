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

/// The plane that a text describes: an axis and a place ("z=12mm", "x=-0.5inch"), or a normal and the
/// distance from the origin along it ("0:0.7:0.7=12mm"; the normal need not have the length 1). Throws
/// LoadError that names `what`.
VPS_SCENES_API SectionPlane sectionPlaneFromText(const std::string& text, const std::string& what);

/// Throws LoadError if the plane cuts no part. The message states the range of the parts along the plane's
/// normal.
VPS_SCENES_API void requireCut(const SectionPlane& plane, const std::vector<DrawnPart>& parts);

}  // namespace vps::scenes
