// SPDX-License-Identifier: BSD-3-Clause
// Which rows of a trade no other row beats.
#pragma once

#include <vector>

#include "vps_scenes/trade.h"

namespace vps::scenes {

/// Marks the rows that were run to the end and that no other such row beats in time a step (99th percentile
/// of processor time), error and memory at once. The reference is a row like any other.
void markFront(std::vector<TradeRow>& rows);

}  // namespace vps::scenes
