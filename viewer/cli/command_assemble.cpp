// SPDX-License-Identifier: BSD-3-Clause
// vps assemble: the main job.
#include <cstdio>

#include "commands.h"
#include "json_out.h"
#include "output.h"
#include "progress_bar.h"
#include "run_report.h"
#include "table.h"
#include "terminal.h"
#include "vps_scenes/assemble.h"
#include "vps_scenes/load_level.h"
#include "vps_scenes/record.h"

namespace vps::viewer {

namespace {

/// What was given up to hold the rate, a line each.
std::string describeLoadChanges(const std::vector<scenes::LoadLevelChange>& load_changes) {
  std::string lines;
  for (const scenes::LoadLevelChange& change : load_changes)
    lines += "pace: at " + fixed(change.time_s, 2) + " s " + (change.is_done ? "" : "(not done) ") +
             change.is + ", since " + change.why + "; " + scenes::describeCost(change) + "\n";
  return lines;
}

/// How well time was kept, in two lines.
std::string describe(const scenes::AssembleResult& result) {
  const scenes::RealTimeResult& kept = *result.real_time;
  const auto us = [](double value) { return fixed(value, 0) + " us"; };
  return "haptic loop: " + std::to_string(result.haptic.count) + " ticks at " +
         fixed(result.haptic_rate_hz, 0) + " Hz, p50 " + us(result.haptic.p50_us) + ", p99 " +
         us(result.haptic.p99_us) + ", longest " + us(result.haptic.max_us) + "; " +
         std::to_string(result.haptic.missed) + " periods missed; due to written " + us(kept.worst_us) +
         " at worst, by " + kept.worst_cause + "\nphysics: " + std::to_string(result.physics.count) +
         " steps at " + fixed(result.physics_rate_hz, 0) + " Hz, p99 " + us(result.physics.p99_us) + "; " +
         std::to_string(kept.physics_missed) + " periods missed, " + fixed(kept.behind_s, 2) +
         " s behind the clock\n" + describeLoadChanges(kept.load_changes);
}

}  // namespace

int runAssemble(const AssembleArguments& given) {
  OutputFolder out(given.out);
  OutputFile json(given.json, {given.scene});
  ProgressBar bar;
  requireNotRead(given.record, {given.scene});
  scenes::Scene scene = sceneFrom(given.scene, given.fidelity, {given.json, given.record});

  scenes::AssembleOptions options;
  const std::optional<VoxMapCache> cache = cacheFrom(given.cache);
  fill(options, bar, cache, given.models_everything);
  options.keep_going = !given.stops_at_failure;
  options.stop = &stopRequested();
  options.is_real_time = given.is_real_time;
  options.degrades = given.degrades;
  options.has_local_contact = given.has_local_contact;
  const scenes::AssembleResult result = given.record.empty()
                                            ? scenes::assemble(scene, options)
                                            : scenes::assembleAndRecord(scene, given.record, options);
  throwIfStopped();

  bar.progress()("writing the report", 1);
  const std::vector<std::string> notes = fillFolder(
      out, scene, result, {"vps assemble " + given.scene + " --out " + given.out, given.has_pictures});
  out.commit();
  json.write(toJson(result));
  bar.clear();

  const bool is_good = printSteps(result);
  for (const std::string& note : notes) warn(note);
  if (result.real_time) {
    for (const std::string& words : result.real_time->warnings) warn(words);
    std::fputs(describe(result).c_str(), stdout);
  }
  if (!given.record.empty()) std::printf("recorded: vps replay %s\n", given.record.c_str());
  std::printf("%s; report: %s/report.html\n", is_good ? "done" : "not done", given.out.c_str());
  return is_good ? kGood : kBad;
}

}  // namespace vps::viewer
