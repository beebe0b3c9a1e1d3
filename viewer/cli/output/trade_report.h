// SPDX-License-Identifier: BSD-3-Clause
// Output of `vps trade`: a table, CSV, a plot.
#pragma once

#include <string>

#include "vps_scenes/planning/trade.h"
#include "vps_viewer/report/plot.h"

namespace vps::viewer {

std::string tradeTable(const scenes::TradeResult& result);
/// One line for each row, SI but for microseconds. A column's name is its path in the JSON file, joined by
/// "_".
std::string tradeCsv(const scenes::TradeResult& result);
/// Error of depth over the time of a step, with the front as a line; writes file + ".png" and file + ".svg".
PlotOutcome plotTrade(const scenes::TradeResult& result, const std::string& file);

}  // namespace vps::viewer
