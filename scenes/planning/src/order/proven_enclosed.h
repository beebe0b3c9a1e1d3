// SPDX-License-Identifier: BSD-3-Clause
// Parts without a path that are proven to have none.
#pragma once

#include <vector>

#include "surface/placed_surface.h"
#include "vps_scenes/planning/plan_types.h"

namespace vps::scenes {

/// Tries to prove of each part without a path that it cannot leave one of the parts that stop it, and sets
/// BlockedPart::enclosed_by. Rigid parts are assumed: a part that cannot leave one part alone cannot leave
/// the assembly in any order. Nothing is proven for parts that are like a wire, nor of a thread, seal or
/// insert whose parts overlap as drawn. At most about a minute of one core for all parts, on all cores.
/// Deterministic.
void proveEnclosed(const std::vector<PlacedSurface>& parts, const CheckResult& checked,
                   std::vector<PlannedAssembly>& assemblies, const Progress& progress);

}  // namespace vps::scenes
