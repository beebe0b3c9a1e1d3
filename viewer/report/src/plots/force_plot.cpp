// SPDX-License-Identifier: BSD-3-Clause
// Forces and torques on the hand over time, as figure 9 of Tripicchio et al.
#include <algorithm>
#include <array>
#include <cmath>

#include "plots/gnuplot.h"
#include "plots/run_plot.h"
#include "vps_viewer/report/plot.h"

namespace vps::viewer {
namespace {

using gnuplot::number;

constexpr std::array<const char*, 4> kPhaseNames = {"reach", "insert", "press", "rest"};
constexpr std::array<const char*, 4> kPhaseColors = {"#FFFFFF", "#E3EEF8", "#FBEBD9", "#EEEEEE"};

// The magnitude is a pale band under the components, so that it is visible where a single component equals
// it.
constexpr const char* kSum = "#B4B4B4";
constexpr double kSumWidth = 4;

/// Places the legend to the right of a panel, at the same distance for all panels.
std::string keyAt(double top) {
  return "set key at screen 0.845, screen " + number(top) + " left top\n";
}

/// Runs of equal step and phase: [start, end) in time.
struct Span {
  double start_s, end_s;
  int step, phase;
};

std::vector<Span> spansOf(const std::vector<scenes::TraceRow>& trace, bool is_by_phase) {
  std::vector<Span> spans;
  for (const scenes::TraceRow& row : trace) {
    const int phase = is_by_phase ? row.phase : 0;
    if (!spans.empty()) spans.back().end_s = row.time_s;
    if (spans.empty() || spans.back().step != row.step || spans.back().phase != phase)
      spans.push_back({row.time_s, row.time_s, row.step, phase});
  }
  return spans;
}

std::string shadePhases(const std::vector<scenes::TraceRow>& trace) {
  std::string out;
  for (const Span& s : spansOf(trace, true))
    if (s.phase >= 1 && s.phase <= 3)
      out += "set object rectangle from first " + number(s.start_s) + ", graph 0 to first " +
             number(s.end_s) + ", graph 1 behind fillcolor rgb \"" +
             kPhaseColors[static_cast<std::size_t>(s.phase)] + "\" fillstyle solid noborder\n";
  return out;
}

/// Step names over the first panel, replaced by a number if there is no room, and a thin line between steps.
std::string nameSteps(const std::vector<scenes::TraceRow>& trace, const std::vector<std::string>& names,
                      bool is_panel_top) {
  const double duration_s = std::max(1e-9, trace.back().time_s - trace.front().time_s);
  std::string out;
  for (const Span& s : spansOf(trace, false)) {
    if (s.start_s > trace.front().time_s)
      out += "set arrow from first " + number(s.start_s) + ", graph 0 to first " + number(s.start_s) +
             ", graph 1 nohead lc rgb \"#999999\" lw 0.8 dt 3 back\n";
    if (!is_panel_top || s.step < 0) continue;
    const auto i = static_cast<std::size_t>(s.step);
    std::string text = std::to_string(s.step + 1);
    if (i < names.size()) {
      const std::string full = text + " " + names[i];
      const double room_px = 1000 * (s.end_s - s.start_s) / duration_s;
      if (7.4 * static_cast<double>(full.size()) < room_px) text = full;
    }
    out += "set label " + gnuplot::quoted(text) + " at first " + number(0.5 * (s.start_s + s.end_s)) +
           ", graph 1.05 center textcolor rgb \"#333333\"\n";
  }
  return out;
}

}  // namespace

PlotOutcome plotForces(const std::vector<scenes::TraceRow>& whole_trace, const std::string& file,
                       const std::vector<std::string>& step_names, int step) {
  std::vector<scenes::TraceRow> trace;
  for (const scenes::TraceRow& row : whole_trace)
    if (step < 0 || row.step == step) trace.push_back(row);
  if (trace.empty()) return {false, "the trace is empty: nothing to plot"};

  std::array<Curve, 8> curves;  // fx fy fz |f| tx ty tz |t|
  Curve depth;
  for (const scenes::TraceRow& row : trace) {
    for (int k = 0; k < 3; ++k) {
      curves[k].emplace_back(row.time_s, row.F_hand_W.f[k]);
      curves[4 + k].emplace_back(row.time_s, row.F_hand_W.tau[k]);
    }
    curves[3].emplace_back(row.time_s, row.F_hand_W.f.norm());
    curves[7].emplace_back(row.time_s, row.F_hand_W.tau.norm());
    depth.emplace_back(row.time_s, 1e6 * row.depth_m);
  }
  std::string script = plotStyle();
  const std::array<const char*, 8> names = {"fx", "fy", "fz", "f", "tx", "ty", "tz", "t"};
  for (std::size_t i = 0; i < curves.size(); ++i) addPoints(script, names[i], curves[i]);
  addPoints(script, "depth", depth);

  // Impacts are triangles and slides are bars along the top of the first panel, above every curve.
  double greatest_N = 0, least_N = 0;
  for (std::size_t k = 0; k < 4; ++k)
    for (const auto& [t, value] : curves[k]) {
      if (!std::isfinite(value)) continue;
      greatest_N = std::max(greatest_N, value);
      least_N = std::min(least_N, value);
    }
  const double range_N = std::max(greatest_N - least_N, 0.1), mark_N = greatest_N + 0.1 * range_N;
  std::vector<std::vector<double>> impacts, slides;
  for (const scenes::ContactEpisode& e : scenes::contactEpisodes(trace)) {
    if (e.is_slide)
      slides.push_back({e.start_s, mark_N, e.end_s - e.start_s, 0});
    else
      impacts.push_back({e.start_s, mark_N});
  }
  std::string marks;
  if (!impacts.empty()) {
    script += gnuplot::dataBlock("impacts", impacts);
    marks += "$impacts with points pt 11 ps 0.9 lc rgb \"#B00020\" title " +
             gnuplot::quoted("impact (" + std::to_string(impacts.size()) + ")") + ", \\\n  ";
  }
  if (!slides.empty()) {
    script += gnuplot::dataBlock("slides", slides);
    marks += "$slides with vectors nohead lw 4 lc rgb \"#CC79A7\" title " +
             gnuplot::quoted("slide (" + std::to_string(slides.size()) + ")") + ", \\\n  ";
  }
  for (std::size_t k = 1; k < kPhaseNames.size(); ++k)
    marks += std::string("keyentry with boxes fillstyle solid fillcolor rgb \"") + kPhaseColors[k] +
             "\" title " + gnuplot::quoted(std::string("phase: ") + kPhaseNames[k]) + ", \\\n  ";

  const double start_s = std::floor(100 * trace.front().time_s) / 100,
               end_s = std::max(trace.back().time_s, start_s + 1e-3);
  script += "set multiplot\nset lmargin at screen 0.075\nset rmargin at screen 0.83\n";
  script += "set xrange [" + number(start_s) + ":" + number(end_s) + "]\nset format x \"\"\n";
  script += shadePhases(trace);
  // The plot has three panels, one below the other, on one time axis.
  script += "set tmargin at screen 0.94\nset bmargin at screen 0.60\n" + keyAt(0.94) +
            nameSteps(trace, step_names, true);
  script +=
      "set yrange [" + number(least_N - 0.05 * range_N) + ":" + number(greatest_N + 0.2 * range_N) + "]\n";
  script += "set ylabel \"force on the hand [N]\" offset 0.5,0\n";
  script += plotLines(
      {{"f", "|F|", kSum, kSumWidth}, {"fx", "Fx", kRed}, {"fy", "Fy", kGreen}, {"fz", "Fz", kBlue}}, marks);
  script += "unset label\nset autoscale y\nset tmargin at screen 0.575\nset bmargin at screen 0.315\n" +
            keyAt(0.575);
  script += "set ylabel \"torque on the hand [N m]\" offset 0.5,0\n";
  script += plotLines(
      {{"t", "|T|", kSum, kSumWidth}, {"tx", "Tx", kRed}, {"ty", "Ty", kGreen}, {"tz", "Tz", kBlue}});
  script += "set tmargin at screen 0.29\nset bmargin at screen 0.09\nset format x \"%g\"\n" + keyAt(0.29);
  script += "set xlabel \"time [s]\"\nset ylabel \"contact depth [µm]\" offset 0.5,0\nset yrange [0:*]\n";
  script += plotLines({{"depth", "greatest depth", kInk, 1.1}});
  script += "unset multiplot\n";
  return gnuplot::draw(script, file, 1400, 900);
}

RunPlot forcePlot() {
  return {"forces", "Forces on the hand", "Force, torque and contact depth over the run.",
          "Force and torque on the hand during this step.",
          [](const scenes::AssembleResult& result, const std::vector<std::string>& step_names, int step,
             const std::string& file) { return plotForces(result.trace, file, step_names, step); }};
}

}  // namespace vps::viewer
