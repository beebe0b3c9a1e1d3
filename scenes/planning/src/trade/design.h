// SPDX-License-Identifier: BSD-3-Clause
// The fidelities that a trade study measures around the scene's own.
#pragma once

#include <vector>

#include "vps_scenes/planning/trade.h"

namespace vps::scenes {

/// The scene's own fidelity; each setting alone coarser and finer, the most informative first; and all
/// settings together coarser and finer.
std::vector<TradeSetting> tradeDesign(const Scene& scene);

/// References to compare the other rows with, the best first: half the lengths, twice the rates and four
/// times the solver iterations; then, for less time, with the scene's own rates; then, for still less time,
/// with 0.7 of the lengths.
std::vector<TradeSetting> tradeReferences(const Scene& scene);

/// Combines, for each setting, the cheapest row whose error is at most a tenth above that of the scene's own
/// fidelity. The name is empty if fewer than two settings change.
TradeSetting tradeSuggestion(const Scene& scene, const std::vector<TradeRow>& rows);

}  // namespace vps::scenes
