// SPDX-License-Identifier: BSD-3-Clause
// Chooses the place within its play at which a part moves along its path.
#pragma once

#include <vector>

#include "ways/pair_motions.h"

namespace vps::scenes {

/// Displacement from a part's target to the place with most room to all sides across a straight path out, for
/// a part that is drawn against one side of its play. A slide that rests on the plate of its dovetail, for
/// example, often catches the edge of that plate if a hand aims for the place where it is drawn. Zero if the
/// part has play to both sides or to none, if it is not stopped within kSightTolerance_m, or if the path is
/// not free from the displaced place.
Vec3 toMostRoom_m(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held,
                  const Vec3& out_W);

}  // namespace vps::scenes
