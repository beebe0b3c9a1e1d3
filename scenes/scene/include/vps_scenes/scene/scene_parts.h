// SPDX-License-Identifier: BSD-3-Clause
// Mass properties of a scene's parts, and groups of parts that move as one body.
#pragma once

#include <string>
#include <vector>

#include "vps/mesh.h"
#include "vps_scenes/cad/import.h"
#include "vps_scenes/export.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Volume, centre and inertia of the solid that a part's mesh stands for (see massOf() in vps/mesh_repair.h),
/// in the part's frame. Simulation, grasp, sound and reports all use this function, with and without models.
/// For a part that is pressed in, the result describes the part as drawn. O(1) if the part has a Solid; else
/// O(n log n) in the first call for a mesh, and O(n) for a hash of the mesh in later calls. Thread-safe.
VPS_SCENES_API MassProperties partMass(const ScenePart& part);

/// Unites two or more parts, in the frame of the first part, whose settings the result has, with these
/// exceptions: the united part is fixed if one part is fixed, may overlap if one part may overlap, and has
/// the greatest deflection and press fit, the total mass divided by the total volume as density, and the
/// colour of the largest part.
VPS_SCENES_API ScenePart unitedPart(const std::string& name, const std::vector<ScenePart>& parts);

/// Replaces the parts of each group by one part, in the place of the group's first part. The scene must not
/// have steps yet.
/// @param groups names of parts of the scene, each in one group at most
VPS_SCENES_API void uniteGroups(Scene& scene, const std::vector<PartGroup>& groups);

}  // namespace vps::scenes
