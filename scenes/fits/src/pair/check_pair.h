// SPDX-License-Identifier: BSD-3-Clause
// Overlap and clearance of two parts.
#pragma once

#include <optional>

#include "surface/placed_surface.h"

namespace vps::scenes {

/// Empty if the parts are farther from each other than near_m. Thread-safe.
std::optional<CheckedPair> checkPair(const PlacedSurface& a, const PlacedSurface& b, double near_m);

/// How far the meshes of two parts may be from their true faces anywhere, both together: the greatest
/// distance of facets from the curved faces that they stand for, cracks, and rounding. No error of a pair's
/// depth is that of its meshes where a flat face shows the overlap. Infinite where one of them has no inside
/// or is not closed: a depth in it has no bound.
double meshError_m(const PlacedSurface& a, const PlacedSurface& b);

}  // namespace vps::scenes
