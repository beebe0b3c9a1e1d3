// SPDX-License-Identifier: BSD-3-Clause
// vps check: measures overlap, clearance, fits and play of an assembly as drawn, and judges rules for pairs.
#include <cstdio>
#include <memory>

#include "input/cad_arguments.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/reports.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps_scenes/fits/check.h"
#include "vps_scenes/fits/part_moves.h"
#include "vps_scenes/fits/rules.h"
#include "vps_viewer/report/pages.h"

namespace vps::viewer {

namespace {

struct CheckArguments {
  std::vector<std::string> assembly;  ///< CAD files in one frame, or one scene file
  std::string near, json, csv, html, pdf;
  std::vector<std::string> between, ignored, moves;
  std::string min_gap, rules;
  CadArguments cad;
  bool has_no_play = false;
};

struct Assembly {
  std::string name;
  std::vector<scenes::DrawnPart> parts;
  std::vector<std::string> read;  ///< files that were read
};

Assembly readScene(const CheckArguments& given, const Progress& progress) {
  const std::string& file = given.assembly.front();
  requireNoCadOptions(file, given.cad);
  const scenes::Scene scene = loadedScene(file, given.cad.cache, progress);
  for (const std::string& warning : scene.warnings) warn(warning);
  Assembly assembly{scene.name, scenes::drawnParts(scene), {file}};
  for (const scenes::ScenePart& part : scene.parts) assembly.read.push_back(part.file);
  return assembly;
}

Assembly readCad(const CheckArguments& given, const Progress& progress) {
  const scenes::Scene scene = groupedScene(
      importedCad(given.assembly, importSettingsFrom(given.cad, kMostTriangles), given.cad, progress),
      given.cad);
  const std::string& first = given.assembly.front();
  for (const std::string& warning : scene.warnings)
    warn(given.assembly.size() > 1 ? warning : first + ": " + warning);
  return {given.assembly.size() > 1 ? listedFiles(given.assembly) : first, scenes::drawnParts(scene),
          given.assembly};
}

void readWishes(const CheckArguments& given, scenes::CheckSettings& settings) {
  for (const std::string& pair : given.between)
    settings.between.push_back(scenes::pairFromText(pair, "--between"));
  for (const std::string& pair : given.ignored)
    settings.ignored.push_back(scenes::pairFromText(pair, "--ignore"));
  if (!given.rules.empty()) settings.rules = scenes::loadRules(given.rules);
  if (given.min_gap.empty()) return;
  scenes::CheckRule& gap = settings.rules.emplace_back();
  gap.name = "--min-gap";
  gap.min_clearance_m = scenes::lengthFromText(given.min_gap, "--min-gap");
  if (!(*gap.min_clearance_m > 0))
    throw LoadError("", "", "--min-gap is " + given.min_gap + "; expected more than 0");
}

int exitStatus(const scenes::CheckResult& result) {
  const scenes::RuleState rules = scenes::worstState(result.rules);
  if (rules == scenes::RuleState::Broken) return kBad;
  const int status = scenes::exitStatusOf(result.verdict());
  return status == kGood && rules == scenes::RuleState::NotDecided ? kNotShown : status;
}

int runCheck(const CheckArguments& given) {
  std::vector<std::string> inputs = given.assembly;
  if (!given.rules.empty()) inputs.push_back(given.rules);
  OutputFile json(given.json, inputs), csv(given.csv, inputs), html(given.html, inputs);
  PdfFile pdf(given.pdf, inputs);
  scenes::CheckSettings settings;
  settings.has_play = !given.has_no_play;
  settings.has_places = true;
  settings.has_sections = settings.has_maps = !given.html.empty() || !given.pdf.empty();
  if (!given.near.empty()) settings.near_m = scenes::lengthFromText(given.near, "--near");
  if (!(settings.near_m >= 0)) throw LoadError("", "", "--near is " + given.near + "; expected 0 or more");
  readWishes(given, settings);
  std::vector<scenes::PartMove> moves;
  for (const std::string& move : given.moves) moves.push_back(scenes::partMoveFromText(move, "--move"));
  ProgressBar bar;
  const bool is_cad = areCadFiles(given.assembly);
  Assembly assembly = is_cad ? readCad(given, bar.progress()) : readScene(given, bar.progress());
  for (const std::string& output : {given.json, given.csv, given.html, given.pdf})
    requireNotRead(output, assembly.read);
  scenes::moveParts(assembly.parts, moves, "--move");
  const scenes::CheckResult result =
      scenes::checkAssembly(assembly.name, assembly.parts, settings, bar.progress());
  throwIfStopped();
  json.write(toJson(result));
  csv.write(checkCsv(result));
  const std::string page = checkPage(result);
  html.write(page);
  bar.clear();
  std::fputs(checkTables(result).c_str(), stdout);
  std::printf("%s\n", checkHeadline(result).c_str());
  pdf.write(page);  // printed last, so that a failure loses no other result
  return exitStatus(result);
}

void addWishOptions(CLI::App& command, const std::shared_ptr<CheckArguments>& given) {
  command
      .add_option("--between", given->between,
                  "measure only pairs of which one part matches A and the other part B: names of parts, "
                  "assemblies or products, in which * stands for any text; may be given several times")
      ->type_name("A,B")
      ->allow_extra_args(false);
  command
      .add_option("--ignore", given->ignored,
                  "leave out pairs of which one part matches A and the other part B; the result says how "
                  "many; may be given several times")
      ->type_name("A,B")
      ->allow_extra_args(false);
  command
      .add_option("--min-gap", given->min_gap,
                  "least clearance of all pairs that are measured, with unit; the exit status is 1 if a pair "
                  "has less, and 3 if the error leaves that open")
      ->type_name("LENGTH");
  command
      .add_option("--rules", given->rules,
                  "file of rules (TOML): bounds of clearance, overlap and axis offset for pairs of parts")
      ->type_name("FILE");
  command
      .add_option("--move", given->moves,
                  "move a part before the check: PART,x,0.1mm along x, y, z or a direction like 0:1:1, or "
                  "PART,rx,2deg about an axis through the part's origin; may be given several times")
      ->type_name("PART,AXIS,BY")
      ->allow_extra_args(false);
}

}  // namespace

std::function<int()> addCheck(CLI::App& command) {
  const auto given = std::make_shared<CheckArguments>();
  command
      .add_option(
          "assembly", given->assembly,
          "CAD files that share one frame, or a scene file (TOML), whose parts are then at their targets")
      ->required()
      ->type_name("CAD|SCENE");
  addCadOptions(command, given->cad);
  addCacheOptions(command, given->cad.cache);
  command.add_option("--near", given->near,
                     "clearance up to which pairs are reported, with unit (default: 1mm)");
  addWishOptions(command, given);
  command.add_flag("--no-play", given->has_no_play,
                   "do not compute the play of parts and their ways out, which take the longest time");
  command.add_option("--csv", given->csv, "CSV file with one number and its error on each line")
      ->type_name("FILE");
  command.add_option("--html", given->html, "write an HTML page with tables")->type_name("FILE");
  addPdfOption(command, given->pdf);
  addJsonOption(command, given->json);
  return [given] { return runCheck(*given); };
}

}  // namespace vps::viewer
