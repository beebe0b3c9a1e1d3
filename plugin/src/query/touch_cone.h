// SPDX-License-Identifier: BSD-3-Clause
// Which planes the corner of a solid can touch.
#pragma once

#include <optional>
#include <span>

#include "query/direction_cone.h"

namespace vps::inline v0 {

/// A corner touches a facet of another part only where its own surface rises from the facet all around: a
/// nut's crest cannot touch the flank it faces away from. Slopes down to kSinTouch are left in, since facets
/// of curved surfaces stand for each other there.
///
/// A cone that holds every unit vector n with n . ray >= -slope for all rays; nothing if there is none.
/// O(rays^3), of which the first twelve are used.
std::optional<DirectionCone> touchCone(std::span<const Vec3> rays, double slope);

}  // namespace vps::inline v0
