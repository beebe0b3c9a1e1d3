// SPDX-License-Identifier: BSD-3-Clause
#include "trade_report.h"

#include <algorithm>

#include "table.h"

namespace vps::viewer {

namespace {

std::string um(double m) {
  return fixed(m * 1e6, 2);
}

/// Its name, or nothing for a number that was not measured.
std::string given(bool is_there, double value) {
  return is_there ? csvNumber(value) : std::string();
}

/// Which line of the plot a row belongs to.
std::string family(scenes::TradeKnob knob) {
  switch (knob) {
    case scenes::TradeKnob::Own:
      return "as it is";
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
               "depth off [um]", "force off [%]", "deepest [um]", "end off [um]", "<front"});
  for (const scenes::TradeRow& row : result.rows) {
    const auto run = [&](double value, int digits) { return row.has_run ? fixed(value, digits) : "-"; };
    const auto probe = [&](double value, int digits) { return row.has_probe ? fixed(value, digits) : "-"; };
    table.add({row.what.name, std::to_string(row.points), fixed(1e-6 * static_cast<double>(row.bytes), 1),
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
  std::string text = csvLine({"setting",
                              "knob",
                              "voxel_m",
                              "spacing_m",
                              "sides",
                              "gradient",
                              "contact",
                              "contact_limit",
                              "haptic_rate_hz",
                              "physics_rate_hz",
                              "solver_iterations",
                              "points",
                              "models_bytes",
                              "run_bytes",
                              "models_s",
                              "query_us",
                              "query_p99_us",
                              "all_points_us",
                              "step_us",
                              "step_p99_us",
                              "tick_us",
                              "tick_p99_us",
                              "distance_error_m",
                              "penetration_error_m",
                              "force_error",
                              "torque_error",
                              "completed",
                              "max_penetration_m",
                              "final_error_m",
                              "final_off_reference_m",
                              "peak_force_off_reference_N",
                              "to_hand_off_reference_J",
                              "injected_J",
                              "on_front"});
  for (const scenes::TradeRow& row : result.rows) {
    const Fidelity& f = row.what.fidelity;
    const bool p = row.has_probe, r = row.has_run, o = row.has_reference;
    text += csvLine({row.what.name,
                     toText(row.what.knob),
                     csvNumber(f.voxel_m),
                     csvNumber(f.spacing_m),
                     toText(f.sides),
                     toText(f.gradient),
                     toText(row.what.contact),
                     std::to_string(f.contact_limit),
                     csvNumber(f.haptic_rate_hz),
                     csvNumber(f.physics_rate_hz),
                     std::to_string(f.solver_iterations),
                     std::to_string(row.points),
                     std::to_string(row.bytes),
                     given(r, static_cast<double>(row.run.bytes)),
                     csvNumber(row.models_wall_s),
                     given(p, row.query.cpu_p50_us),
                     given(p, row.query.cpu_p99_us),
                     given(p, row.all_points.cpu_p50_us),
                     given(r, row.run.physics.cpu_p50_us),
                     given(r, row.run.physics.cpu_p99_us),
                     given(r, row.run.haptic.cpu_p50_us),
                     given(r, row.run.haptic.cpu_p99_us),
                     given(p, row.probe.distance_m),
                     given(p, row.probe.penetration_m),
                     given(p, row.probe.force),
                     given(p, row.probe.torque),
                     r ? (row.run.completed ? "1" : "0") : "",
                     given(r, row.run.deepest_m),
                     given(r, row.run.final_error_m),
                     given(o, row.off.final_m),
                     given(o, row.off.peak_force_N),
                     given(o, row.off.to_hand_J),
                     given(r, row.run.injected_J),
                     row.is_on_front ? "1" : "0"});
  }
  return text;
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
    const std::string name = family(row.what.knob);
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
