// SPDX-License-Identifier: BSD-3-Clause
// Plots, drawn by the program gnuplot.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "vps_device/dual_arm/character.h"
#include "vps_scenes/run/contact_episodes.h"
#include "vps_scenes/run/result.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

struct Series {
  std::string name;
  std::vector<std::pair<double, double>> points;
  bool has_markers = false;
  bool is_scatter = false;  ///< markers without lines
};

struct Plot {
  std::string title, x_label, y_label;  ///< labels carry the unit: "force [N]"
  std::vector<Series> series;
  bool is_log_x = false, is_log_y = false;
};

/// Whether a plot was written. The functions that plot do not throw, so that a missing gnuplot never ends a
/// run.
struct PlotOutcome {
  bool is_written = false;
  std::string failure_reason;  ///< the reason for the user: "gnuplot is not installed (Debian: apt install
                               ///< gnuplot-nox)"
  explicit operator bool() const { return is_written; }
};

/// Whether gnuplot is in a folder of PATH.
VPS_VIEWER_API bool hasGnuplot();

/// Plots forces and torques on the hand over time as figure 9 of Tripicchio et al., with marked impacts,
/// shaded phases and named steps. Writes file + ".png" and file + ".svg"; the same trace gives the same
/// bytes.
/// @param step_names by index of the step; steps without a name get their number
/// @param step       index of the only step to plot; -1: all steps
VPS_VIEWER_API PlotOutcome plotForces(const std::vector<scenes::TraceRow>& trace, const std::string& file,
                                      const std::vector<std::string>& step_names = {}, int step = -1);

/// Plots curves over a common horizontal axis. Writes file + ".png" and file + ".svg".
VPS_VIEWER_API PlotOutcome plotSeries(const Plot& plot, const std::string& file);

/// Plots figure 5 of Tripicchio et al., the greatest vertical force of left arm, right arm and pair, for the
/// dual arm of this program. The left diagram shows the least force in each column of the workspace, as
/// surfaces over x and y. The right diagram shows the least force over x and z, along y, with Tripicchio et
/// al.'s 5 N and 12 N. Writes file + ".png" and file + ".svg"; the same input gives the same bytes.
VPS_VIEWER_API PlotOutcome plotVerticalForces(const std::vector<device::VerticalForceAt>& forces,
                                              const std::string& file);

}  // namespace vps::viewer
