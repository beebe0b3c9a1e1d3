// SPDX-License-Identifier: BSD-3-Clause
// vps compare: compares a trainee's recorded run with an expert's, for training.
#include <cstdio>
#include <memory>
#include <optional>

#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/table.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps_scenes/uses/compare.h"
#include "vps_viewer/report/pages.h"

namespace vps::viewer {

namespace {

struct CompareArguments {
  std::string expert, trainee;
  std::string out, json;  ///< folder and file for results; empty: none
  std::optional<double> pass;
  bool has_pdf = false;
};

std::string comparisonTable(const scenes::RunComparison& result) {
  Table table({"<part", "score", "time [s]", "expert", "path [mm]", "expert", "off its path [mm]", "peak [N]",
               "expert"});
  for (const scenes::ComparedStep& s : result.steps)
    table.add({s.part, s.is_done ? fixed(s.score, 0) : "not done", fixed(s.trainee.duration_s, 2),
               fixed(s.expert.duration_s, 2), fixed(1e3 * s.trainee.path_m, 1),
               fixed(1e3 * s.expert.path_m, 1), fixed(1e3 * s.deviation_m, 2),
               fixed(s.trainee.peak_force_N, 2), fixed(s.expert.peak_force_N, 2)});
  return table.text();
}

int runCompare(const CompareArguments& given) {
  if (given.has_pdf) requirePdf();
  std::optional<OutputFolder> out;
  if (!given.out.empty()) out.emplace(given.out);
  OutputFile json(given.json, {given.expert, given.trainee});
  const scenes::RunComparison result =
      scenes::compareRuns(device::loadRecording(given.expert), device::loadRecording(given.trainee));
  std::vector<std::string> notes = result.notes;
  const std::string as_json = toJson(result);
  if (out) {
    notes = writeComparePage(result, out->partial());
    out->write("compare.json", as_json);
    out->commit();
  }
  json.write(as_json);
  std::fputs(comparisonTable(result).c_str(), stdout);
  for (const std::string& note : notes) warn(note);
  std::printf("Score %s of 100%s.\n", fixed(result.score, 0).c_str(),
              given.pass ? (", " + fixed(*given.pass, 0) + " are needed").c_str() : "");
  if (out) std::printf("report: %s/compare.html\n", given.out.c_str());
  if (given.has_pdf) requirePrinted(given.out + "/compare.html", given.out + "/compare.pdf");
  return given.pass && result.score < *given.pass ? kBad : kGood;
}

}  // namespace

std::function<int()> addCompare(CLI::App& command) {
  const auto given = std::make_shared<CompareArguments>();
  command.add_option("expert", given->expert, "recording of the reference")->required()->type_name("EXPERT");
  command.add_option("trainee", given->trainee, "recording to compare with it")
      ->required()
      ->type_name("TRAINEE");
  command.add_option("-o,--out", given->out, "folder for compare.html with pictures, and compare.json")
      ->type_name("DIR");
  command.add_flag("--pdf", given->has_pdf, "also write compare.pdf, printed by Chromium")->needs("--out");
  command.add_option("--pass", given->pass, "required score: below it the exit status is 1")
      ->check(CLI::Range(0.0, 100.0))
      ->type_name("SCORE");
  addJsonOption(command, given->json);
  return [given] { return runCompare(*given); };
}

}  // namespace vps::viewer
