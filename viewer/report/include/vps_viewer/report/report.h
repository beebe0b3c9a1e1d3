// SPDX-License-Identifier: BSD-3-Clause
// The report of an assembly run: an HTML page with pictures and plots.
#pragma once

#include <string>
#include <vector>

#include "vps/errors.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

struct ReportOptions {
  std::string command;       ///< command that repeats the run: "vps assemble scene.toml --out out"
  Progress progress;         ///< may be empty; its exceptions end the writing
  bool has_pictures = true;  ///< false: tables and plots only, without OpenGL
  int width = 1280, height = 960;
};

struct ReportOutcome {
  std::string file;                ///< the page
  std::vector<std::string> notes;  ///< missing programs or libraries (EGL, gnuplot) and how to install them
};

/// Writes report.html, trace.csv, plots/ (of the run and of each step) and pictures/ into dir, which is made
/// if it does not exist. The page and the result list pictures and plots that could not be made. The same
/// input gives the same bytes, except for the section of wall-clock times. Throws LoadError when dir
/// cannot be written.
VPS_VIEWER_API ReportOutcome writeReport(const scenes::Scene& scene, const scenes::AssembleResult& result,
                                         const std::string& dir, const ReportOptions& options = {});

/// A page of the steps that are finished while a run goes on, without pictures. A browser loads it again
/// every five seconds.
VPS_VIEWER_API std::string unfinishedPage(const scenes::Scene& scene, const scenes::AssembleResult& so_far);

}  // namespace vps::viewer
