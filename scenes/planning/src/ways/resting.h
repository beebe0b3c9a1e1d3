// SPDX-License-Identifier: BSD-3-Clause
// How a part rests in its place: whether it leans, sinks or tips over, and its room within its play.
#pragma once

#include <vector>

#include "ways/pair_motions.h"

namespace vps::scenes {

/// True for a part that is carried only by holes with level axes, and whose centre of mass lies outside all
/// of these holes along the axis: a bolt through a wall, before its nut is on. Such a part leans by the play
/// of its hole. Straight motions do not detect such a lean, since the part turns.
/// @param held  parts in place
bool leansInHole(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held);

/// Whether the part sinks by more than its position tolerance, because it is drawn above all parts that could
/// carry it, or off the middle of a hole. The position tolerance is that of the part's tightest fit, or 0.5
/// mm without a fit.
bool sinksFromItsPlace(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held);

/// True for a part that sinks onto the parts in place and then touches them at points that cannot balance its
/// weight without friction: a plate that stands in a slot while its centre of mass is not above the slot.
bool tipsOver(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held);

/// Displacement from a part's target to the place with most room to all sides across a straight path out, for
/// a part that is drawn against one side of its play. A slide that rests on the plate of its dovetail, for
/// example, often catches the edge of that plate if a hand aims for the place where the slide is drawn. The
/// displacement is zero if the part has play to both sides or to none, if the part is not stopped within
/// kSightTolerance_m, or if the path is not free from the displaced place.
Vec3 toMostRoom_m(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held,
                  const Vec3& out_W);

}  // namespace vps::scenes
