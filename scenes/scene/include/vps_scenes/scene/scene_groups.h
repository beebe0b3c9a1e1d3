// SPDX-License-Identifier: BSD-3-Clause
// Parts of a scene that move as one body.
#pragma once

#include <string>
#include <vector>

#include "vps_scenes/cad/import.h"
#include "vps_scenes/export.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// The parts as one, in the frame of the first, whose settings it has, but for these: it is fixed if one of
/// them is, may overlap if one may, has the greatest deflection and press fit, the density of their mass over
/// their volume, and the colour of the largest. Of two parts or more.
VPS_SCENES_API ScenePart unitedPart(const std::string& name, const std::vector<ScenePart>& parts);

/// Replaces the parts of each group by one part, in the place of its first. The scene has no steps yet.
/// @param groups names of parts of the scene, each in one group at most
VPS_SCENES_API void uniteGroups(Scene& scene, const std::vector<PartGroup>& groups);

}  // namespace vps::scenes
