// SPDX-License-Identifier: BSD-3-Clause
// How near a part comes to others on its way.
#pragma once

#include <vector>

#include "surface/placed_surface.h"
#include "vps/errors.h"
#include "vps_scenes/planning/plan_types.h"

namespace vps::scenes {

/// What the ways of a plan are measured on.
struct Placing {
  const std::vector<PlacedSurface>& parts;
  const CheckResult& checked;
  Vec3 up_W;
};

/// Sets PlannedStep::clearance_m, nearest and fit_clearance_m of each step. A distance changes by no more
/// than the surface moves, so that a leg is divided where a lesser one can be: within a micrometre, or a
/// thousandth of it. On all cores.
void measureWays(const Placing& placing, PlannedAssembly& assembly, const Progress& progress);

}  // namespace vps::scenes
