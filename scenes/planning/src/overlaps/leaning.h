// SPDX-License-Identifier: BSD-3-Clause
// Parts that lean in their holes, sink or tip over until another part holds them.
#pragma once

#include <vector>

#include "ways/pair_motions.h"

namespace vps::scenes {

/// True for a part that is carried only by holes with level axes, and whose centre of mass lies outside all
/// of them along the axis: a bolt through a wall, before its nut is on. Such a part leans by the play of its
/// hole. Straight motions do not detect this, since the part turns.
/// @param held  parts in place
bool leansInHole(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held);

/// Whether the part sinks by more than its position tolerance, because it is drawn above all parts that could
/// carry it, or off the middle of a hole. The tolerance is that of its tightest fit, or 0.5 mm without a fit.
bool sinksFromItsPlace(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held);

/// True for a part that sinks onto the parts in place and then touches them at points that cannot balance its
/// weight without friction: a plate that stands in a slot while its centre of mass is not above the slot.
bool tipsOver(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held);

}  // namespace vps::scenes
