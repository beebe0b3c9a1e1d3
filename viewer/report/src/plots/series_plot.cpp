// SPDX-License-Identifier: BSD-3-Clause
// Curves over a common axis.
#include <array>

#include "plots/gnuplot.h"
#include "plots/plot_style.h"
#include "vps_viewer/report/plot.h"

namespace vps::viewer {

PlotOutcome plotSeries(const Plot& plot, const std::string& file) {
  static constexpr std::array<const char*, 7> kColors = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                         "#E69F00", "#56B4E9", "#333333"};
  std::string script = plotStyle();
  if (plot.is_log_x) script += "set logscale x\n";
  if (plot.is_log_y) script += "set logscale y\n";
  if (!plot.title.empty())
    script += "set title " + gnuplot::quoted(plot.title) + " textcolor rgb \"#222222\"\n";
  script +=
      "set xlabel " + gnuplot::quoted(plot.x_label) + "\nset ylabel " + gnuplot::quoted(plot.y_label) + "\n";
  std::string commands;
  bool has_points = false;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Series& s = plot.series[i];
    const std::string name = std::string("s").append(std::to_string(i));
    addPoints(script, name, s.points);
    has_points = has_points || !s.points.empty();
    commands += std::string("$").append(name) + " with " +
                (s.is_scatter    ? "points pt 7 ps 1.1"
                 : s.has_markers ? "linespoints pt 7 ps 0.8"
                                 : "lines") +
                " lw 1.6 lc rgb \"" + kColors[i % kColors.size()] + "\" title " + gnuplot::quoted(s.name) +
                ", \\\n  ";
  }
  if (!has_points) return {false, "no points to plot"};
  return gnuplot::draw(script + plotLines({}, commands), file, 1100, 620);
}

}  // namespace vps::viewer
