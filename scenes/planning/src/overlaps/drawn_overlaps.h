// SPDX-License-Identifier: BSD-3-Clause
// What overlaps as drawn are taken for.
#pragma once

#include <optional>
#include <vector>

#include "fits/fastener_shape.h"
#include "vps_scenes/planning/plan_types.h"

namespace vps::scenes {

/// Of a shaft that is made thinner, or a hole that is made wider, on each side. With 20 um in diameter a hand
/// found the hole in 100 of 100 tries; this is more, for shafts that pass several holes.
inline constexpr double kPassingRoom_m = 25e-6;

/// A choice for each overlap of the parts: one of OverlapKind, with what follows from it. A part that is left
/// out needs no other.
/// @param shapes of the parts, see fastenerShapes()
/// @param fixed  parts that are not left out, ascending
std::vector<OverlapChoice> overlapChoices(const std::vector<PlacedSurface>& parts, const CheckResult& checked,
                                          const std::vector<std::optional<FastenerShape>>& shapes,
                                          const std::vector<std::size_t>& fixed);

/// A choice for each part that is no body: a face, or a surface without an inside. It has no mass that a hand
/// could carry. Empty where no part is a body.
std::vector<OverlapChoice> noVolumeChoices(const std::vector<PlacedSurface>& parts,
                                           const std::vector<std::size_t>& fixed);

/// The parts of which choices say that they are left out: those without volume, of parts drawn twice all but
/// the first, and flexible ones. Ascending.
std::vector<std::size_t> leftOut(const std::vector<PlacedSurface>& parts,
                                 const std::vector<OverlapChoice>& choices);

}  // namespace vps::scenes
