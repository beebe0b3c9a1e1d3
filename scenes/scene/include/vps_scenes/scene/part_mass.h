// SPDX-License-Identifier: BSD-3-Clause
// Mass properties of a scene's part.
#pragma once

#include "vps/mesh.h"
#include "vps_scenes/export.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Volume, centre and inertia of the solid that a part's mesh stands for (see massOf() in vps/mesh_repair.h),
/// in the part's frame: the one source of them for simulation, grasp, sound and reports. The same with and
/// without models. Of a part that is pressed in, as it is drawn. Cheap if the part has a Solid; else O(n log
/// n) the first time, and a hash of the mesh after that. Thread-safe.
VPS_SCENES_API MassProperties partMass(const ScenePart& part);

}  // namespace vps::scenes
