// SPDX-License-Identifier: BSD-3-Clause
// Parts that lean in their holes until something else holds them.
#pragma once

#include <vector>

#include "plan/pair_motions.h"

namespace vps::scenes::inline v0 {

/// True for a part that only holes around level axes carry, with its centre of mass beside all of them along
/// the axis: a bolt through a wall, before its nut is on. It leans by the play of its hole. Its drawn contact
/// does not tell that, as it does not turn.
/// @param held  what is in place
bool leansInHole(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held);

}  // namespace vps::scenes::inline v0
