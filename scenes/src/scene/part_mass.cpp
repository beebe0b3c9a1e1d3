// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/part_mass.h"

#include "vps/mesh_repair.h"

namespace vps::scenes::inline v0 {

MassProperties partMass(const ScenePart& part) {
  // The solid of a part that is pressed in is smaller than the part.
  const bool has_own_solid = part.model && part.model->solid && !(part.press_fit_m > 0);
  return has_own_solid ? part.model->solid->mass() : solidMass(part.part.mesh, part.part.name);
}

}  // namespace vps::scenes::inline v0
