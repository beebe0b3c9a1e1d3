// SPDX-License-Identifier: BSD-3-Clause
// Figure 5 of Tripicchio et al.: the vertical force of the dual arm over its workspace.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "plots/gnuplot.h"
#include "vps_viewer/report/plot.h"

namespace vps::viewer {
namespace {

using gnuplot::number;

// The least forces (left, right, both, sum) in a column (x, y) or at one y. Keys are whole micrometres, so
// that equal places have equal keys.
using Least = std::array<double, 4>;
template <typename Key>
using Leasts = std::map<Key, Least>;

long wholeMicrometres(double m) {
  return std::lround(m * 1e6);
}

template <typename Key>
void add(Leasts<Key>& leasts, const Key& key, const device::VerticalForce& force) {
  const Least values = {force.left_N, force.right_N, force.both_N, force.sum_N};
  const auto [at, is_new] = leasts.emplace(key, values);
  if (is_new) return;
  for (std::size_t i = 0; i < values.size(); ++i) at->second[i] = std::min(at->second[i], values[i]);
}

/// Columns x, y [mm] and the forces, in scans of equal x with an empty line between them, which is gnuplot's
/// format for surfaces.
std::string surfaceBlock(const Leasts<std::pair<long, long>>& leasts) {
  std::string out = "$surface << END_OF_DATA\n";
  long scan = leasts.begin()->first.first;
  for (const auto& [place, least] : leasts) {
    if (place.first != scan) out += '\n';
    scan = place.first;
    out += number(1e-3 * static_cast<double>(place.first)) + ' ' +
           number(1e-3 * static_cast<double>(place.second));
    for (const double value : least) out += ' ' + number(value);
    out += '\n';
  }
  return out + "END_OF_DATA\n";
}

std::string lineBlock(const Leasts<long>& leasts) {
  std::vector<std::vector<double>> rows;
  for (const auto& [y_um, least] : leasts)
    rows.push_back({1e-3 * static_cast<double>(y_um), least[0], least[1], least[2], least[3]});
  return gnuplot::dataBlock("line", rows);
}

// Tripicchio et al.'s colours, in Okabe and Ito's palette: right red, left blue, both yellow.
constexpr const char* kPlotStyle = R"(
set encoding utf8
left = "#0072B2"; right = "#D55E00"; both = "#E69F00"; ink = "#333333"
set tics nomirror out scale 0.6 textcolor rgb ink
set grid lc rgb "#D9D9D9" lw 0.6 lt 1
set multiplot title "Greatest upward force, motors at their continuous limits, handle straight" \
  textcolor rgb ink
)";

constexpr const char* kSurfaces = R"(
set origin 0, 0
set size 0.54, 0.93
set border 1+2+4+8+16+32+64+256+512 lc rgb "#AAAAAA" lw 0.6
set label 1 "over the workspace: at each x and y the least along z" at screen 0.27, 0.90 center \
  textcolor rgb ink
set xlabel "x [mm]" offset 0.5,-0.8 textcolor rgb ink
set ylabel "y, left to right [mm]" offset 1.0,-0.8 textcolor rgb ink
set zlabel "force [N]" rotate parallel offset 1.5,0 textcolor rgb ink
set xtics -200,100,200 offset -0.6,-0.5
set ytics -200,100,200 offset 0.8,-0.5
set ztics 5
set xyplane at 0
set zrange [0:20]
unset colorbox
set view 66, 52, 1.0, 1.0
set pm3d depthorder border lc rgb "#555555" lw 0.4
set style fill transparent solid 0.72
set key at screen 0.03, screen 0.87 left top Left reverse vertical samplen 1.2 textcolor rgb ink
splot $surface using 1:2:5 with pm3d fillcolor rgb both notitle, \
      $surface using 1:2:3 with pm3d fillcolor rgb left notitle, \
      $surface using 1:2:4 with pm3d fillcolor rgb right notitle, \
      keyentry with lines lw 7 lc rgb left title "left alone", \
      keyentry with lines lw 7 lc rgb right title "right alone", \
      keyentry with lines lw 7 lc rgb both title "both"
)";

constexpr const char* kLines = R"(
reset
set tics nomirror out scale 0.6 textcolor rgb ink
set grid lc rgb "#E3E3E3" lw 0.6 lt 1
set border 3 lc rgb "#666666" lw 0.8
set lmargin at screen 0.61
set rmargin at screen 0.975
set tmargin at screen 0.85
set bmargin at screen 0.14
set label 1 "from left to right: at each y the least over x and z" at screen 0.79, 0.90 center textcolor rgb ink
set xlabel "y, left to right [mm]" textcolor rgb ink
set ylabel "force [N]" offset 0.5,0 textcolor rgb ink
set yrange [0:25]
set xtics 100
unset key
set arrow 1 from graph 0, first 12 to graph 1, first 12 nohead lc rgb ink lw 0.9 dt 3 front
set label 2 "12 N, paper's pair" at graph 0.01, first 12 left offset 0,-0.65 textcolor rgb ink
set arrow 2 from graph 0, first 5 to graph 1, first 5 nohead lc rgb ink lw 0.9 dt 3 front
set label 3 "5 N, paper's arm alone" at graph 0.01, first 5 left offset 0,-0.65 textcolor rgb ink
)";

constexpr const char* kCurves = R"(
plot $line using 1:5 with lines lw 1.4 dt 2 lc rgb both, \
     $line using 1:4 with lines lw 2.4 lc rgb both, \
     $line using 1:2 with lines lw 1.8 lc rgb left, \
     $line using 1:3 with lines lw 1.8 lc rgb right
unset multiplot
)";

/// Labels a curve at `share` of its length from left to right, `lines` of text above it.
std::string nameCurve(int tag, const Leasts<long>& along, std::size_t curve, double share, double lines,
                      const char* color, const char* name) {
  const auto steps = static_cast<std::ptrdiff_t>(share * static_cast<double>(along.size() - 1));
  const auto at = std::next(along.begin(), steps);
  return "set label " + std::to_string(tag) + " \"" + name + "\" at " +
         number(1e-3 * static_cast<double>(at->first)) + ", " + number(at->second[curve]) +
         " center offset 0," + number(lines) + " textcolor rgb " + color + " front\n";
}

}  // namespace

PlotOutcome plotVerticalForces(const std::vector<device::VerticalForceAt>& forces, const std::string& file) {
  if (forces.empty()) return {false, "no places to plot"};
  Leasts<std::pair<long, long>> columns;
  Leasts<long> along;
  for (const device::VerticalForceAt& at : forces) {
    add(columns, {wholeMicrometres(at.p_DE.x()), wholeMicrometres(at.p_DE.y())}, at.force);
    add(along, wholeMicrometres(at.p_DE.y()), at.force);
  }
  const std::string names = nameCurve(4, along, 0, 0.87, -1.2, "left", "left alone") +
                            nameCurve(5, along, 1, 0.13, -1.2, "right", "right alone") +
                            nameCurve(6, along, 2, 0.5, -1.8, "both", "both") +
                            nameCurve(7, along, 3, 0.5, 1.4, "both", "both, if the hand bears the couple");
  return gnuplot::draw(
      surfaceBlock(columns) + lineBlock(along) + kPlotStyle + kSurfaces + kLines + names + kCurves, file,
      1400, 660);
}

}  // namespace vps::viewer
