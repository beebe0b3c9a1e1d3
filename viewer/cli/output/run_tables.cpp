// SPDX-License-Identifier: BSD-3-Clause
#include "output/reports.h"

#include <cstdio>

#include "output/command.h"
#include "output/json_out.h"
#include "output/table.h"
#include "output/terminal.h"
#include "vps_scenes/run/load_level.h"
#include "vps_scenes/run/result_fields.h"
#include "vps_scenes/run/simulate.h"
#include "vps_scenes/uses/ergonomics.h"
#include "vps_viewer/report/csv.h"
#include "vps_viewer/report/report.h"
#include "vps_viewer/report/words.h"

namespace vps::viewer {

namespace {

std::string tableOf(const std::vector<scenes::StepResult>& steps) {
  Table table({"<step", "<verdict", "time [s]", "deepest [um]", "limit [um]", "peak [N]", "peak [N m]",
               "drift [um]"});
  for (const scenes::StepResult& step : steps)
    table.add({step.part, words(step.verdict), fixed(step.duration_s, 2),
               fixed(step.max_penetration_m * 1e6, 2), fixed(step.penetration_limit_m * 1e6, 2),
               fixed(step.peak_force_N, 1), fixed(step.peak_torque_Nm, 2),
               // For a part that did not reach its target the drift is the distance that it fell.
               step.completed ? fixed(step.rest_drift_m * 1e6, 2) : "-"});
  return table.text();
}

/// Describes each change of the load level in one line.
std::string describeLoadChanges(const std::vector<scenes::LoadLevelChange>& load_changes) {
  std::string lines;
  for (const scenes::LoadLevelChange& change : load_changes)
    lines += "load shedding: at " + fixed(change.time_s, 2) + " s " + (change.is_done ? "" : "(not done) ") +
             change.is + ", since " + change.why + "; " + scenes::describeCost(change) + "\n";
  return lines;
}

/// Describes periods and times of the haptic loop and of physics in one line each.
std::string describe(const scenes::AssembleResult& result) {
  const scenes::RealTimeResult& timing = *result.real_time;
  const auto us = [](double value) { return fixed(value, 0) + " us"; };
  return "haptic loop: " + std::to_string(result.haptic.count) + " ticks at " +
         fixed(result.haptic_rate_hz, 0) + " Hz, p50 " + us(result.haptic.p50_us) + ", p99 " +
         us(result.haptic.p99_us) + ", longest " + us(result.haptic.max_us) + "; " +
         std::to_string(result.haptic.missed) +
         " periods missed; longest time from a tick's due time to its output " + us(timing.worst_us) +
         ", because of " + timing.worst_cause + "\nphysics: " + std::to_string(result.physics.count) +
         " steps at " + fixed(result.physics_rate_hz, 0) + " Hz, p99 " + us(result.physics.p99_us) +
         "; p99 of the delay of a step's start " + us(timing.physics_late.p99_us) + "; " +
         std::to_string(timing.physics_missed) + " periods missed, " + fixed(timing.behind_s, 2) +
         " s behind the clock\n" + describeLoadChanges(timing.load_changes);
}

}  // namespace

static_assert(scenes::exitStatusOf(scenes::Verdict::Fits) == kGood);
static_assert(scenes::exitStatusOf(scenes::Verdict::Blocked) == kBad);
static_assert(scenes::exitStatusOf(scenes::Verdict::NotShown) == kNotShown);

std::vector<std::string> fillFolder(const OutputFolder& out, const scenes::Scene& scene,
                                    const scenes::AssembleResult& result, const RunFiles& files) {
  ReportOptions report;
  report.command = files.command;
  report.has_pictures = files.has_pictures;
  report.progress = files.progress;
  ReportOutcome outcome = writeReport(scene, result, out.partial(), report);
  throwIfStopped();
  out.write("steps.csv", toCsv(result.steps, scenes::kStepFields));
  out.write("assemble.json", toJson(result));
  out.write("ergonomics.json", toJson(measureErgonomics(scene, result.trace)));
  return std::move(outcome.notes);
}

std::string fidelityWords(const Fidelity& fidelity) {
  return "voxels of " + fixed(1e3 * fidelity.voxel_m, 3) + " mm, points every " +
         fixed(1e3 * fidelity.spacing_m, 3) + " mm";
}

void printSteps(const scenes::AssembleResult& result, const Fidelity& fidelity) {
  std::fputs(tableOf(result.steps).c_str(), stdout);
  for (const scenes::StepResult& step : result.steps) {
    const char* name = step.part.c_str();
    if (!step.reason.empty()) std::printf("%s: %s\n", name, step.reason.c_str());
    if (step.completed && !step.by_contact && !step.is_taken_off)
      std::printf("%s: assembled by contact: %s\n", name, contactWords(step).c_str());
    if (step.moved_m > 0) std::printf("%s: %s\n", name, movedWords(step).c_str());
    if (!step.aligned_by.empty())
      std::printf("%s: the part is within its tolerance; '%s' moves it to its exact target in a later step\n",
                  name, step.aligned_by.c_str());
    if (step.index_count > 0)
      std::printf(
          "%s: the device was recentred %s, because the path is longer than its workspace, or turns "
          "farther\n",
          name, step.index_count == 1 ? "once" : (std::to_string(step.index_count) + " times").c_str());
  }
  if (const std::string put = putAtTargetWords(result); !put.empty()) std::printf("%s\n", put.c_str());
  if (result.contacts_left_out > 0)
    warn(std::to_string(result.contacts_left_out) +
         " points near contact exceeded the limit of a query; choose a coarser spacing");
  if (!result.fast_turns.empty()) warn(inWords(result.fast_turns, fidelity));
}

void printOutcome(const scenes::Scene& scene, const scenes::AssembleResult& result,
                  const std::vector<std::string>& notes, const std::string& record, const std::string& out) {
  std::printf("%s: %s\n", scene.name.c_str(), fidelityWords(scene.fidelity).c_str());
  printSteps(result, scene.fidelity);
  for (const std::string& note : notes) warn(note);
  if (result.real_time) {
    for (const std::string& words : result.real_time->warnings) warn(words);
    std::fputs(describe(result).c_str(), stdout);
  }
  if (!record.empty()) std::printf("recorded: vps replay %s\n", record.c_str());
  if (const std::string ease = easeWords(result); !ease.empty()) std::printf("%s\n", ease.c_str());
  std::printf("%s\nreport: %s/report.html\n", verdictLine(result).c_str(), out.c_str());
}

}  // namespace vps::viewer
