// SPDX-License-Identifier: BSD-3-Clause
// The report of an assembly run: one HTML page with its pictures and plots beside it.
#pragma once

#include <string>
#include <vector>

#include "vps/progress.h"
#include "vps_scenes/result.h"
#include "vps_scenes/scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

struct ReportOptions {
  std::string command;       ///< how to repeat the run: "vps assemble scene.toml --out out"
  Progress progress;         ///< may be empty
  bool has_pictures = true;  ///< false: no OpenGL, tables and plots only
  int width = 1280, height = 960;
};

struct ReportOutcome {
  std::string file;                ///< the page
  std::vector<std::string> notes;  ///< what is missing and how to get it: no EGL, no gnuplot
};

/// Writes report.html, trace.csv, plots/ (forces of the run and of each step) and pictures/ into dir (made if
/// need be). Pictures or plots that cannot be made become notes, in the page too. Everything repeats byte for
/// byte but what the page marks as measured on the wall clock. Throws std::runtime_error when dir cannot be
/// written.
VPS_VIEWER_API ReportOutcome writeReport(const scenes::Scene& scene, const scenes::AssembleResult& result,
                                         const std::string& dir, const ReportOptions& options = {});

/// The time series as CSV: a header line, then one row a sample, SI units in the column names.
/// Throws std::runtime_error when the file cannot be written.
VPS_VIEWER_API void writeTraceCsv(const std::vector<scenes::TraceRow>& trace, const std::string& file);

/// Text made safe to stand in HTML, in elements and in quoted attributes.
VPS_VIEWER_API std::string escapeHtml(const std::string& text);

}  // namespace vps::viewer
