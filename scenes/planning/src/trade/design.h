// SPDX-License-Identifier: BSD-3-Clause
// The fidelities that a trade measures around the scene's own.
#pragma once

#include <vector>

#include "vps_scenes/planning/trade.h"

namespace vps::scenes {

/// The scene's own, each knob alone coarser and finer (the most informative first), and all together coarser
/// and finer.
std::vector<TradeSetting> tradeDesign(const Scene& scene);

/// References to compare the other rows with, the best first: half the lengths, twice the rates and four
/// times the solver iterations; for less time the scene's own rates; for still less 0.7 of the lengths.
std::vector<TradeSetting> tradeReferences(const Scene& scene);

/// Combines, for each knob, the cheapest setting whose error is at most a tenth above the scene's own. Its
/// name is empty where that changes fewer than two knobs.
TradeSetting tradeSuggestion(const Scene& scene, const std::vector<TradeRow>& rows);

}  // namespace vps::scenes
