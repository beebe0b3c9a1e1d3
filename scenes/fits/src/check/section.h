// SPDX-License-Identifier: BSD-3-Clause
// The outlines of parts in a plane.
#pragma once

#include <vector>

#include "surface/placed_surface.h"

namespace vps::scenes {

/// Cuts at fits and at overlaps: clashes first, the deepest first, then press fits, then fits, the tightest
/// first.
std::vector<CheckedSection> checkSections(const std::vector<PlacedSurface>& parts, const CheckResult& result,
                                          const Progress& progress);

/// The outline of one part in the plane of a section, cut off a little outside of the picture. Points of the
/// surface in the plane itself count as in front of it, so that each chain closes. O(facets near the plane).
SectionOutline outlineOf(const PlacedSurface& part, const CheckedSection& section);

}  // namespace vps::scenes
