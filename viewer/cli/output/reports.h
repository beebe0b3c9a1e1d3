// SPDX-License-Identifier: BSD-3-Clause
// Tables, sentences and files in which commands report their results: check_tables.cpp, revision_tables.cpp,
// plan_tables.cpp, run_tables.cpp and trade_tables.cpp. JSON is in json_out.h, and the HTML pages are in
// viewer/report.
#pragma once

#include <string>
#include <vector>

#include "output/output.h"
#include "vps/errors.h"
#include "vps_scenes/fits/check_types.h"
#include "vps_scenes/fits/revisions.h"
#include "vps_scenes/planning/plan.h"
#include "vps_scenes/planning/trade.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/report/plot.h"

namespace vps::viewer {

// --- vps check

/// Tables of pairs, fits and parts. Tables that are empty or were not requested are left out.
std::string checkTables(const scenes::CheckResult& result);
/// The result in one sentence.
std::string checkHeadline(const scenes::CheckResult& result);
/// CSV with a line for each number: what, a, b, quantity, value, error.
std::string checkCsv(const scenes::CheckResult& result);
/// Tables of the differences of two revisions, and one sentence: revision_tables.cpp.
std::string revisionTables(const scenes::RevisionChanges& changes);

// --- vps plan

/// A line for each different fastener with the names of the parts; empty if there are no fasteners.
std::string fastenerText(const std::vector<scenes::Fastener>& fasteners);
/// Tables of the steps of all assemblies, and the parts for which no path was found.
std::string planTables(const scenes::PlanResult& plan);
/// The result in one sentence, with the verdict where it is not Fits.
std::string planHeadline(const scenes::PlanResult& plan, const std::vector<scenes::WayFault>& faults);
/// The fault in words: "the path of 'peg' leads through 'wall', 3.20 mm deep at (1.0, 2.0, 3.0) mm (0.01 mm
/// allowed)"
std::string inWords(const scenes::WayFault& fault);

/// The verdict of a plan whose written paths have these faults. A fault of a path that the plan has found is
/// no proof that no other path exists, so that it turns Fits into NotShown. A part that nothing carries is no
/// fault of a plan, which holds such parts.
scenes::Verdict verdictOf(const scenes::PlanResult& plan, const std::vector<scenes::WayFault>& faults);

/// The verdict of the paths that a scene states: Blocked if one has a fault for certain, NotShown if an
/// overlap on a path may be an error of the meshes, else Fits.
scenes::Verdict verdictOf(const std::vector<scenes::WayFault>& faults);

// --- vps assemble, vps render and vps replay

struct RunFiles {
  std::string command;  ///< command line that repeats the run
  bool has_pictures = true;
  Progress progress;  ///< may be empty; its exceptions end the writing
};

/// Fills the folder, which is not yet committed: report.html with pictures and plots, trace.csv, steps.csv
/// and assemble.json. Returns notes on pictures and plots that could not be drawn, for stderr at the end.
std::vector<std::string> fillFolder(const OutputFolder& out, const scenes::Scene& scene,
                                    const scenes::AssembleResult& result, const RunFiles& files);

/// The fidelity in words: "voxels of 0.250 mm, points every 0.500 mm".
std::string fidelityWords(const Fidelity& fidelity);

/// Prints the table of steps, and a line for each problem of a step.
/// @param fidelity fidelity of the run
void printSteps(const scenes::AssembleResult& result, const Fidelity& fidelity);

/// Prints the outcome of a run: fidelity, steps, notes of fillFolder(), timing of a run in real time,
/// recording, verdict.
/// @param record  file of the recording; empty: none
/// @param out     folder of the results
void printOutcome(const scenes::Scene& scene, const scenes::AssembleResult& result,
                  const std::vector<std::string>& notes, const std::string& record, const std::string& out);

// --- vps trade

/// A table with a row for each measured setting.
std::string tradeTable(const scenes::TradeResult& result);
/// One line for each row, in SI units except for microseconds. A column's name is its path in the JSON file,
/// joined by
/// "_".
std::string tradeCsv(const scenes::TradeResult& result);
/// Plots the error of depth over the time of a step, with the Pareto front as a line, into file + ".png" and
/// file + ".svg".
PlotOutcome plotTrade(const scenes::TradeResult& result, const std::string& file);

}  // namespace vps::viewer
