// SPDX-License-Identifier: BSD-3-Clause
// What `vps assemble` and `vps replay` tell of a run: tables, report, JSON.
#pragma once

#include <string>

#include "output.h"
#include "vps/progress.h"
#include "vps_scenes/result.h"
#include "vps_scenes/scene.h"

namespace vps::viewer {

/// Fills the folder (not yet committed): report.html with pictures and plots, trace.csv, steps.csv,
/// assemble.json. Notes on what could not be drawn go to stderr at the end, by the caller.
struct RunFiles {
  std::string command;  ///< how to repeat it
  bool has_pictures = true;
};
std::vector<std::string> fillFolder(const OutputFolder& out, const scenes::Scene& scene,
                                    const scenes::AssembleResult& result, const RunFiles& files);

/// Prints the table of steps, and a line for each step that is not good. Returns whether all are.
bool printSteps(const scenes::AssembleResult& result);

}  // namespace vps::viewer
