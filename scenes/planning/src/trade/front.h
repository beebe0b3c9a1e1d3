// The Pareto front of the rows of a trade study.
// The Pareto front of a trade's rows.
#pragma once

#include <vector>

#include "vps_scenes/planning/trade.h"

namespace vps::scenes {

/// Marks the completed rows that no other completed row dominates in step time (99th percentile of processor
/// time), error and memory. The reference is treated as any other row.
void markFront(std::vector<TradeRow>& rows);

}  // namespace vps::scenes
