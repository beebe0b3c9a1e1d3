// SPDX-License-Identifier: BSD-3-Clause
// Classifies overlaps of the parts as drawn.
#pragma once

#include <optional>
#include <vector>

#include "fits/fastener_shape.h"
#include "vps_scenes/planning/plan_types.h"

namespace vps::scenes {

/// Radial clearance that a resized shaft or hole gets. With 20 um in diameter the virtual hand found the hole
/// in 100 of 100 tries; shafts that pass several holes need more.
inline constexpr double kPassingRoom_m = 25e-6;

/// A choice for each overlapping pair: its OverlapKind and the change to the planned scenes. Pairs with a
/// part that is already left out get no choice.
/// @param shapes of the parts, see fastenerShapes()
/// @param fixed  parts that must not be left out, ascending
std::vector<OverlapChoice> overlapChoices(const std::vector<PlacedSurface>& parts, const CheckResult& checked,
                                          const std::vector<std::optional<FastenerShape>>& shapes,
                                          const std::vector<std::size_t>& fixed);

/// A choice for each part that is not a body: a face, or a surface without an inside, which has no mass that
/// a hand could carry. Empty if no part is a body.
std::vector<OverlapChoice> noVolumeChoices(const std::vector<PlacedSurface>& parts,
                                           const std::vector<std::size_t>& fixed);

/// The parts that the choices leave out: parts without volume, all but the first of parts drawn twice, and
/// flexible parts. Ascending.
std::vector<std::size_t> leftOut(const std::vector<PlacedSurface>& parts,
                                 const std::vector<OverlapChoice>& choices);

}  // namespace vps::scenes
