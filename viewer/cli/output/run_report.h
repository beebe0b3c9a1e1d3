// SPDX-License-Identifier: BSD-3-Clause
// Output that `vps assemble`, `vps render` and `vps replay` share: tables, report, JSON.
#pragma once

#include <string>
#include <vector>

#include "output/output.h"
#include "vps/errors.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/scene.h"

namespace vps::viewer {

struct RunFiles {
  std::string command;  ///< that repeats the run
  bool has_pictures = true;
};

/// Fills the folder, which is not yet committed: report.html with pictures and plots, trace.csv, steps.csv
/// and assemble.json. Returns notes on what could not be drawn, for stderr at the end.
std::vector<std::string> fillFolder(const OutputFolder& out, const scenes::Scene& scene,
                                    const scenes::AssembleResult& result, const RunFiles& files);

/// "voxels of 0.250 mm, points every 0.500 mm"
std::string fidelityWords(const Fidelity& fidelity);

/// Prints the table of steps, and a line for each problem of a step.
/// @param fidelity  with which the scene was run
void printSteps(const scenes::AssembleResult& result, const Fidelity& fidelity);

/// Prints what a run came to: fidelity, steps, notes of fillFolder(), timing of a run by the clock,
/// recording, verdict.
/// @param record  file of the recording; empty: none
/// @param out     folder of the results
void printOutcome(const scenes::Scene& scene, const scenes::AssembleResult& result,
                  const std::vector<std::string>& notes, const std::string& record, const std::string& out);

/// The program's exit status.
int statusOf(scenes::Verdict verdict);

}  // namespace vps::viewer
