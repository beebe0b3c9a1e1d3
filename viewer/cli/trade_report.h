// SPDX-License-Identifier: BSD-3-Clause
// What `vps trade` tells: a table, a CSV, a plot.
#pragma once

#include <string>

#include "vps_scenes/trade.h"
#include "vps_viewer/plot.h"

namespace vps::viewer {

std::string tradeTable(const scenes::TradeResult& result);
/// One line a row, SI but for microseconds; the columns are in README.md.
std::string tradeCsv(const scenes::TradeResult& result);
/// Time a step over error of depth, the front as a line; file + ".png" and file + ".svg".
PlotOutcome plotTrade(const scenes::TradeResult& result, const std::string& file);

}  // namespace vps::viewer
