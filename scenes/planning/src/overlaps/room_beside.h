// SPDX-License-Identifier: BSD-3-Clause
// Where in its play a part goes along its way.
#pragma once

#include <vector>

#include "ways/pair_motions.h"

namespace vps::scenes {

/// From its place to where it has most room to all sides across a straight way out, for a part that is drawn
/// against one side of its play: a slide that rests on the plate of its dovetail meets the edge of that plate
/// as often as not, if a hand aims for the place where it is drawn. Zero where it has play to both sides or
/// to none, where it is not stopped within what sight can tell, or where the way is not free from there.
Vec3 toMostRoom_m(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held,
                  const Vec3& out_W);

}  // namespace vps::scenes
