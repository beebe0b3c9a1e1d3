// SPDX-License-Identifier: BSD-3-Clause
// Shafts that are drawn exactly as wide as their holes.
#pragma once

#include <vector>

#include "surface/placed_surface.h"
#include "vps_scenes/planning/plan_types.h"

namespace vps::scenes {

/// A choice for each shaft whose diameter equals that of its hole within the error: as drawn there is neither
/// clearance nor interference, so that a run by contact cannot decide whether it passes. In the planned scene
/// the shaft is thinner by twice kPassingRoom_m.
/// @param others  choices for overlaps; their parts and pairs get no second choice
std::vector<OverlapChoice> lineToLineChoices(const std::vector<PlacedSurface>& parts,
                                             const CheckResult& checked,
                                             const std::vector<OverlapChoice>& others);

}  // namespace vps::scenes
