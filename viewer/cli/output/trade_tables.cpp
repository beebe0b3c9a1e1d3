// SPDX-License-Identifier: BSD-3-Clause
#include "output/reports.h"

#include <algorithm>

#include "output/table.h"
#include "vps_scenes/planning/trade_fields.h"
#include "vps_viewer/report/csv.h"

namespace vps::viewer {

namespace {

/// Name of the plot's series to which a row belongs.
std::string family(scenes::TradeKnob knob) {
  switch (knob) {
    case scenes::TradeKnob::Own:
      return "own settings";
    case scenes::TradeKnob::Voxel:
      return "voxel size";
    case scenes::TradeKnob::Spacing:
      return "point spacing";
    case scenes::TradeKnob::Together:
      return "together";
    case scenes::TradeKnob::Reference:
      return "reference";
    default:
      return "other knobs";
  }
}

}  // namespace

std::string tradeTable(const scenes::TradeResult& result) {
  Table table({"<setting", "points", "MB", "query [us]", "no tree", "step [us]", "p99", "tick [us]", "p99",
               "depth error [um]", "force error [%]", "deepest [um]", "end differs [um]", "<front"});
  for (const scenes::TradeRow& row : result.rows) {
    const auto run = [&](double value, int digits) { return row.has_run ? fixed(value, digits) : "-"; };
    const auto probe = [&](double value, int digits) { return row.has_probe ? fixed(value, digits) : "-"; };
    table.add({row.setting.name, std::to_string(row.points), fixed(1e-6 * static_cast<double>(row.bytes), 1),
               probe(row.query.cpu_p50_us, 1), probe(row.all_points.cpu_p50_us, 1),
               run(row.run.physics.cpu_p50_us, 0), run(row.run.physics.cpu_p99_us, 0),
               run(row.run.haptic.cpu_p50_us, 1), run(row.run.haptic.cpu_p99_us, 1),
               probe(row.probe.penetration_m * 1e6, 2), probe(100 * row.probe.force, 1),
               row.has_run && !row.run.completed ? "failed" : run(row.run.deepest_m * 1e6, 2),
               row.has_reference ? um(row.off.final_m) : "-", row.is_on_front ? "*" : ""});
  }
  return table.text();
}

std::string tradeCsv(const scenes::TradeResult& result) {
  return toCsv(result.rows, std::tuple_cat(scenes::kTradeRowFields, scenes::kTradeRowWallFields));
}

PlotOutcome plotTrade(const scenes::TradeResult& result, const std::string& file) {
  Plot plot;
  plot.title = result.scene + ", " + result.excerpt;
  plot.x_label = "physics step, 99th percentile of processor time [µs]";
  plot.y_label = "error of depth [µm]";
  plot.is_log_x = plot.is_log_y = true;
  Series front{"front", {}, false};
  for (const scenes::TradeRow& row : result.rows) {
    if (!row.has_run || !row.has_probe) continue;
    const std::pair<double, double> point = {row.run.physics.cpu_p99_us, 1e6 * scenes::errorOf(row)};
    if (row.is_on_front) front.points.push_back(point);
    const std::string name = family(row.setting.knob);
    auto series =
        std::find_if(plot.series.begin(), plot.series.end(), [&](const Series& s) { return s.name == name; });
    if (series == plot.series.end()) series = plot.series.insert(series, {name, {}, true, true});
    series->points.push_back(point);
  }
  std::sort(front.points.begin(), front.points.end());
  plot.series.push_back(front);
  return plotSeries(plot, file);
}

}  // namespace vps::viewer
