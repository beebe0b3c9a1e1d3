// SPDX-License-Identifier: BSD-3-Clause
// The Pareto front of a trade's rows.
#pragma once

#include <vector>

#include "vps_scenes/planning/trade.h"

namespace vps::scenes {

/// Marks the completed rows that no other completed row dominates in time of a step (99th percentile of
/// processor time), error and memory. The reference is a row like any other.
void markFront(std::vector<TradeRow>& rows);

}  // namespace vps::scenes
