// SPDX-License-Identifier: BSD-3-Clause
// Least distance of a part to others along its path.
#pragma once

#include <vector>

#include "surface/placed_surface.h"
#include "vps/errors.h"
#include "vps_scenes/planning/plan_types.h"

namespace vps::scenes {

/// The placed parts of a plan, with which its paths are measured.
struct Placing {
  const std::vector<PlacedSurface>& parts;
  const CheckResult& checked;
  Vec3 up_W;
};

/// Sets PlannedStep::clearance_m, nearest and fit_clearance_m of each step. A distance changes by no more
/// than the surface moves; a leg is bisected until no smaller distance is possible, within a micrometre or a
/// thousandth of the distance. Runs on all cores.
void measureWays(const Placing& placing, PlannedAssembly& assembly, const Progress& progress);

}  // namespace vps::scenes
