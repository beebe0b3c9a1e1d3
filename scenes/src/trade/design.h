// SPDX-License-Identifier: BSD-3-Clause
// Which fidelities are worth measuring around a scene's own.
#pragma once

#include <vector>

#include "vps_scenes/trade.h"

namespace vps::scenes {

/// The scene's own, each knob by itself coarser and finer (most telling first), all together coarser and
/// finer.
std::vector<TradeTry> tradeDesign(const Scene& scene);

/// What the other rows are compared with, the best first: half the lengths, twice the rates, four times the
/// solver; then, for want of time, the scene's own rates; then 0.7 of the lengths.
std::vector<TradeTry> tradeReferences(const Scene& scene);

/// Each knob where it is cheapest without an error that is more than a tenth above the scene's own; empty
/// name where that is the scene's own.
TradeTry tradeSuggestion(const Scene& scene, const std::vector<TradeRow>& rows);

}  // namespace vps::scenes
