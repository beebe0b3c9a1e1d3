// SPDX-License-Identifier: BSD-3-Clause
// A check of parts that are prepared already, and its stages: play, sections, clearance maps.
#pragma once

#include <vector>

#include "surface/placed_surface.h"

namespace vps::scenes {

/// Checks parts that are prepared already, as checkAssembly() does.
CheckResult checkPlaced(const std::string& name, const std::vector<PlacedSurface>& placed,
                        const CheckSettings& settings, const Progress& progress);

/// Fills play and removal directions of result.parts, which has the order of `parts`. Pairs and fits of
/// `result` must be filled. Runs on all cores and reports progress on the caller's thread.
void checkPlay(const std::vector<PlacedSurface>& parts, CheckResult& result, const CheckSettings& settings,
               const Progress& progress);

/// Sections at overlaps and fits: clashes first (the deepest first), then press fits, then fits (the tightest
/// first). Runs on all cores.
std::vector<CheckedSection> checkSections(const std::vector<PlacedSurface>& parts, const CheckResult& result,
                                          const Progress& progress);

/// Sections through all parts by planes that the user chose. Throws LoadError for a plane that cuts no part.
/// Runs on all cores.
std::vector<PlaneSection> planeSections(const std::vector<PlacedSurface>& parts,
                                        const std::vector<SectionPlane>& planes, const Progress& progress);

/// The outline of one part in the plane of a section, clipped to a square that is a little larger than the
/// picture. Vertices in the plane count as in front of it, so that each chain closes. O(facets near the
/// plane).
SectionOutline outlineOf(const PlacedSurface& part, const CheckedSection& section);

/// Clearance maps of the parts that have another part within near_m; the parts with the least clearance come
/// first. Runs on all cores.
std::vector<ClearanceMap> clearanceMaps(const std::vector<PlacedSurface>& parts, const CheckResult& result,
                                        double near_m, const Progress& progress);

}  // namespace vps::scenes
