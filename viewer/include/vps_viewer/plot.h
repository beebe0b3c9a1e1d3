// SPDX-License-Identifier: BSD-3-Clause
// Plots by gnuplot, which runs as a program of its own and is fed by a pipe.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "vps_scenes/contact_episodes.h"
#include "vps_scenes/result.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

struct Series {
  std::string name;
  std::vector<std::pair<double, double>> points;
  bool has_markers = false;
  bool is_scatter = false;  ///< markers alone
};

struct Plot {
  std::string title, x_label, y_label;  ///< labels carry the unit: "force [N]"
  std::vector<Series> series;
  bool is_log_x = false, is_log_y = false;
};

/// What a plot came to. A plot is never worth a run: nothing here throws.
struct PlotOutcome {
  bool is_written = false;
  std::string failure_reason;  ///< for a person: "gnuplot is not installed (Debian: apt install gnuplot-nox)"
  explicit operator bool() const { return is_written; }
};

/// Is there a gnuplot to run?
VPS_VIEWER_API bool hasGnuplot();

/// Forces and torques on the hand over time, as figure 9 of the paper: impacts marked, phases shaded, steps
/// named. Writes file + ".png" and file + ".svg"; the same trace gives the same bytes.
/// @param step_names by index of step; missing ones are numbered
/// @param step       plot only this step; -1: all
VPS_VIEWER_API PlotOutcome plotForces(const std::vector<scenes::TraceRow>& trace, const std::string& file,
                                      const std::vector<std::string>& step_names = {}, int step = -1);

/// Any lines over a common axis; file + ".png" and file + ".svg".
VPS_VIEWER_API PlotOutcome plotSeries(const Plot& plot, const std::string& file);

}  // namespace vps::viewer
