// SPDX-License-Identifier: BSD-3-Clause
// Shafts that are drawn as wide as the holes that they go through.
#pragma once

#include <vector>

#include "surface/placed_surface.h"
#include "vps_scenes/planning/plan_types.h"

namespace vps::scenes {

/// A choice for each shaft whose diameter cannot be told from that of a hole that it is in: as drawn there is
/// neither clearance nor interference, so that no run by contact can tell whether it passes. In the planned
/// scene the shaft is thinner by twice kPassingRoom_m.
/// @param others  choices for overlaps; their parts and pairs need no other
std::vector<OverlapChoice> lineToLineChoices(const std::vector<PlacedSurface>& parts,
                                             const CheckResult& checked,
                                             const std::vector<OverlapChoice>& others);

}  // namespace vps::scenes
