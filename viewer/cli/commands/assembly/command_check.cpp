// SPDX-License-Identifier: BSD-3-Clause
// vps check: measures overlap, clearance, fits and play of an assembly as drawn.
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
#include "vps_viewer/report/pages.h"

namespace vps::viewer {

namespace {

struct CheckArguments {
  std::vector<std::string> assembly;  ///< CAD files in one frame, or one scene file
  std::string near, json, csv, html, pdf;
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

int runCheck(const CheckArguments& given) {
  const std::vector<std::string>& inputs = given.assembly;
  OutputFile json(given.json, inputs), csv(given.csv, inputs), html(given.html, inputs);
  PdfFile pdf(given.pdf, inputs);
  scenes::CheckSettings settings;
  settings.has_play = !given.has_no_play;
  settings.has_places = true;
  settings.has_sections = settings.has_maps = !given.html.empty() || !given.pdf.empty();
  if (!given.near.empty()) settings.near_m = scenes::lengthFromText(given.near, "--near");
  if (!(settings.near_m >= 0)) throw LoadError("", "", "--near is " + given.near + "; expected 0 or more");
  ProgressBar bar;
  const bool is_cad = areCadFiles(given.assembly);
  const Assembly assembly = is_cad ? readCad(given, bar.progress()) : readScene(given, bar.progress());
  for (const std::string& output : {given.json, given.csv, given.html, given.pdf})
    requireNotRead(output, assembly.read);
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
  return scenes::exitStatusOf(result.verdict());
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
