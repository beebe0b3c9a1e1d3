// SPDX-License-Identifier: BSD-3-Clause
// The plots of a report. run_plot_list.inc names them; each has a .cpp of its own.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vps_scenes/run/result.h"
#include "vps_viewer/report/plot.h"

namespace vps::viewer {

struct RunPlot {
  std::string name;          ///< name of the files plots/NAME.png and .svg
  std::string heading;       ///< heading of the section in the report
  std::string caption;       ///< caption of the plot of the whole run
  std::string step_caption;  ///< caption of the plot of one step; empty: no plots of steps
  /// Writes file + ".png" and file + ".svg". @param step index; -1: the whole run
  std::function<PlotOutcome(const scenes::AssembleResult& result, const std::vector<std::string>& step_names,
                            int step, const std::string& file)>
      draw;
};

#define RUN_PLOT(make) RunPlot make();
#include "plots/run_plot_list.inc"
#undef RUN_PLOT

/// All plots, in the order of the report.
inline std::vector<RunPlot> runPlots() {
  return {
#define RUN_PLOT(make) make(),
#include "plots/run_plot_list.inc"
#undef RUN_PLOT
  };
}

}  // namespace vps::viewer
