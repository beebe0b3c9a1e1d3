// SPDX-License-Identifier: BSD-3-Clause
// Parts that lean in their holes, or tip over, until something else holds them.
#pragma once

#include <vector>

#include "ways/pair_motions.h"

namespace vps::scenes {

/// True for a part that only holes around level axes carry, with its centre of mass beside all of them along
/// the axis: a bolt through a wall, before its nut is on. It leans by the play of its hole. Its drawn contact
/// does not tell that, as it does not turn.
/// @param held  what is in place
bool leansInHole(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held);

/// Whether the part is drawn above all that could carry it, or beside its middle in a hole, so that it sinks
/// by more than it may be off in its place: by what its tightest fit allows, or 0.5 mm without one.
bool sinksFromItsPlace(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held);

/// True for a part that sinks onto what is in place and then touches it at points that cannot balance its
/// weight without friction: a plate that stands in a slot with its centre of mass beside the slot.
bool tipsOver(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held);

}  // namespace vps::scenes
