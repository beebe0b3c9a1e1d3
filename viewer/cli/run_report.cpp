// SPDX-License-Identifier: BSD-3-Clause
#include "run_report.h"

#include <cstdio>

#include "json_out.h"
#include "table.h"
#include "terminal.h"
#include "vps_viewer/report.h"

namespace vps::viewer {

namespace {

std::string tableOf(const std::vector<scenes::StepResult>& steps) {
  Table table({"<step", "<completed", "time [s]", "deepest [um]", "limit [um]", "peak [N]", "peak [N m]",
               "drift [um]"});
  for (const scenes::StepResult& step : steps)
    table.add({step.part, step.completed ? "yes" : "no", fixed(step.duration_s, 2),
               fixed(step.max_penetration_m * 1e6, 2), fixed(step.penetration_limit_m * 1e6, 2),
               fixed(step.peak_force_N, 1), fixed(step.peak_torque_Nm, 2),
               fixed(step.rest_drift_m * 1e6, 2)});
  return table.text();
}

std::string csvOf(const std::vector<scenes::StepResult>& steps) {
  std::string out = csvLine({"part", "completed", "start_s", "duration_s", "max_penetration_m",
                             "penetration_limit_m", "deepest_against", "field_penetration_m", "peak_force_N",
                             "peak_torque_Nm", "impacts", "slides", "final_error_m", "final_error_rad",
                             "rest_drift_m", "rest_s", "index_points", "failure_reason"});
  for (const scenes::StepResult& step : steps)
    out +=
        csvLine({step.part, step.completed ? "1" : "0", csvNumber(step.start_s), csvNumber(step.duration_s),
                 csvNumber(step.max_penetration_m), csvNumber(step.penetration_limit_m), step.deepest_against,
                 csvNumber(step.field_penetration_m), csvNumber(step.peak_force_N),
                 csvNumber(step.peak_torque_Nm), std::to_string(step.impacts), std::to_string(step.slides),
                 csvNumber(step.final_error_m), csvNumber(step.final_error_rad), csvNumber(step.rest_drift_m),
                 csvNumber(step.rest_s), std::to_string(step.index_points), step.failure_reason});
  return out;
}

}  // namespace

std::vector<std::string> fillFolder(const OutputFolder& out, const scenes::Scene& scene,
                                    const scenes::AssembleResult& result, const RunFiles& files) {
  ReportOptions report;
  report.command = files.command;
  report.has_pictures = files.has_pictures;
  ReportOutcome outcome = writeReport(scene, result, out.partial(), report);
  throwIfStopped();
  out.write("steps.csv", csvOf(result.steps));
  out.write("assemble.json", toJson(result));
  return std::move(outcome.notes);
}

bool printSteps(const scenes::AssembleResult& result) {
  std::fputs(tableOf(result.steps).c_str(), stdout);
  bool is_good = result.completed;
  for (const scenes::StepResult& step : result.steps) {
    const char* name = step.part.c_str();
    if (!step.completed) std::printf("%s: %s\n", name, step.failure_reason.c_str());
    if (step.index_points > 0)
      std::printf("%s: taken anew %s on the way, which is longer than the device's workspace\n", name,
                  step.index_points == 1 ? "once" : (std::to_string(step.index_points) + " times").c_str());
    if (!scenes::isWithinLimit(step))
      std::printf("%s: deepest against %s, beyond its limit\n", name, step.deepest_against.c_str());
    if (!scenes::isAtRest(step))
      std::printf("%s: drifted more than %g um after it was let go\n", name, scenes::kRestDriftLimit_m * 1e6);
    is_good = is_good && scenes::isGood(step);
  }
  if (result.contacts_left_out > 0)
    warn(std::to_string(result.contacts_left_out) +
         " near points found no room in a query; take a coarser spacing");
  return is_good;
}

}  // namespace vps::viewer
