// SPDX-License-Identifier: BSD-3-Clause
// vps replay: runs a recording again and compares it bit for bit.
#include <cstdio>
#include <memory>
#include <optional>

#include "input/scene_arguments.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/reports.h"
#include "output/table.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps_scenes/run/replay.h"
#include "vps_viewer/report/csv.h"

namespace vps::viewer {

namespace {

struct ReplayArguments {
  std::string recording;
  CacheArguments cache;
  std::string out, json;
  std::string csv;              ///< folder for the recorded channels as tables; empty: none
  bool is_tables_only = false;  ///< writes the tables and does not run
};

void writeTables(const device::RecordedRun& run, const OutputFolder& out) {
  for (const auto& [name, text] : device::csvTables(run)) out.write(name + ".csv", text);
  std::string about = "key,value\n";
  for (const auto& [key, value] : run.head.about) about += csvLine({key, value});
  out.write("about.csv", about);
}

/// Prints the result of the replay. Returns the exit status.
int verdict(const device::RecordedRun& run, const scenes::ReplayResult& replayed) {
  const double end_s = replayed.result.simulated_s;
  if (!replayed.departure.empty()) {
    if (!replayed.other_version.empty()) warn(run.file + " " + replayed.other_version);
    std::printf("the replay differs from the recording at %s\n", replayed.departure.c_str());
    return kBad;
  }
  std::printf("the replay has the same bits as the recording: %zu entries up to %.3f s\n", replayed.equal,
              end_s);
  if (run.damage.empty()) return kGood;
  warn(run.file + " " + run.damage);
  return kBad;
}

int runReplay(const ReplayArguments& given) {
  if (given.is_tables_only && given.csv.empty())
    throw LoadError("", "", "--no-run leaves nothing to do without --csv DIR");
  std::optional<OutputFolder> out, csv;
  if (!given.out.empty()) out.emplace(given.out);
  if (!given.csv.empty()) csv.emplace(given.csv);
  OutputFile json(given.json, {given.recording});
  const device::RecordedRun recorded = device::loadRecording(given.recording);
  if (csv) {
    writeTables(recorded, *csv);
    csv->commit();
  }
  if (given.is_tables_only) {
    if (!recorded.damage.empty()) warn(recorded.file + " " + recorded.damage);
    return recorded.damage.empty() ? kGood : kBad;
  }

  ProgressBar bar;
  scenes::ReplayOptions options;
  options.progress = bar.progress();
  const std::optional<VoxMapCache> cache = cacheFrom(given.cache);
  options.cache = cache ? &*cache : nullptr;
  options.stop = &stopRequested();
  const scenes::ReplayResult replayed = scenes::replay(recorded, options);
  throwIfStopped();

  std::vector<std::string> notes;
  if (out) {
    bar.progress()("writing the report", 1);
    notes = fillFolder(*out, replayed.scene, replayed.result,
                       {"vps replay " + given.recording, true, bar.progress()});
    out->commit();
  }
  json.write(toJson(replayed.result));
  bar.clear();
  printSteps(replayed.result, replayed.scene.fidelity);
  for (const std::string& note : notes) warn(note);
  return verdict(recorded, replayed);
}

}  // namespace

std::function<int()> addReplay(CLI::App& command) {
  const auto given = std::make_shared<ReplayArguments>();
  command.add_option("recording", given->recording, "recording that vps assemble --record wrote")
      ->required()
      ->type_name("RECORDING");
  command.add_option("--csv", given->csv, "folder for the recorded channels as tables")->type_name("DIR");
  command.add_flag("--no-run", given->is_tables_only, "with --csv: write the tables and do not run");
  command.add_option("--out", given->out, "folder for a report, as vps assemble writes it")->type_name("DIR");
  addCacheOptions(command, given->cache);
  addJsonOption(command, given->json);
  return [given] { return runReplay(*given); };
}

}  // namespace vps::viewer
