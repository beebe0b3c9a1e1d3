// SPDX-License-Identifier: BSD-3-Clause
// The planes that the corner of a solid can touch.
#pragma once

#include <algorithm>
#include <optional>
#include <span>

#include "query/direction_cone.h"

namespace vps {

/// True if a corner's surface rises from a plane with normal n all around, or falls from it by no more than
/// the slope. Only then can the corner touch a facet of another part in that plane: a nut's crest cannot
/// touch the flank from which it faces away. Slopes down to kSinTouch are allowed, since facets only
/// approximate curved surfaces.
/// @param rays  from the corner along its surface, unit; in the normal's frame
inline bool risesFrom(std::span<const Vec3> rays, const Vec3& n, double slope) {
  return std::all_of(rays.begin(), rays.end(), [&](const Vec3& ray) { return n.dot(ray) >= -slope; });
}

/// A cone that contains every unit vector n with n . ray >= -slope for all rays; nothing if there is no such
/// vector. Uses the first twelve rays. O(rays^3).
std::optional<DirectionCone> touchCone(std::span<const Vec3> rays, double slope);

}  // namespace vps
