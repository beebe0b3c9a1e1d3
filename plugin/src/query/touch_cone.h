// SPDX-License-Identifier: BSD-3-Clause
// Which planes the corner of a solid can touch.
#pragma once

#include <algorithm>
#include <optional>
#include <span>

#include "query/direction_cone.h"

namespace vps {

/// True if a corner's surface rises from a plane with this normal all around, or falls from it by no more
/// than the slope. A corner touches a facet of another part only then: a nut's crest cannot touch the flank
/// it faces away from. Slopes down to kSinTouch are left in, since facets of curved surfaces stand for each
/// other there.
/// @param rays  from the corner along its surface, unit; in the normal's frame
inline bool risesFrom(std::span<const Vec3> rays, const Vec3& n, double slope) {
  return std::all_of(rays.begin(), rays.end(), [&](const Vec3& ray) { return n.dot(ray) >= -slope; });
}

/// A cone that holds every unit vector n with n . ray >= -slope for all rays; nothing if there is none.
/// O(rays^3), of which the first twelve are used.
std::optional<DirectionCone> touchCone(std::span<const Vec3> rays, double slope);

}  // namespace vps
