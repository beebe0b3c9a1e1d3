// SPDX-License-Identifier: BSD-3-Clause
// vps check: measures overlap, clearance, fits and play of an assembly as drawn, and judges rules for pairs.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "input/cad_arguments.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/reports.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps_scenes/fits/check.h"
#include "vps_scenes/fits/part_moves.h"
#include "vps_scenes/fits/revisions.h"
#include "vps_scenes/fits/rules.h"
#include "vps_viewer/report/pages.h"

namespace vps::viewer {

namespace {

struct CheckArguments {
  std::vector<std::string> assembly;  ///< CAD files in one frame, or one scene file
  std::vector<std::string> against;   ///< CAD files or a scene of the new revision; empty: none
  std::vector<std::string> sections;  ///< planes as text
  std::string near, json, csv, html, pdf;
  std::vector<std::string> between, ignored, moves;
  std::string min_gap, rules;
  CadArguments cad;
  bool has_no_play = false, is_strict = false;
};

struct Assembly {
  std::string name;
  std::string title;  ///< name without folders
  std::vector<scenes::DrawnPart> parts;
  std::vector<std::string> read;  ///< files that were read
};

Assembly readScene(const CheckArguments& given, const Progress& progress) {
  const std::string& file = given.assembly.front();
  requireNoCadOptions(file, given.cad);
  const scenes::Scene scene = loadedScene(file, given.cad.cache, progress);
  for (const std::string& warning : scene.warnings) warn(warning);
  Assembly assembly{scene.name, scene.name, scenes::drawnParts(scene), {file}};
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
  std::string title;
  for (const std::string& file : given.assembly)
    title += (title.empty() ? "" : ", ") + std::filesystem::path(file).filename().string();
  return {given.assembly.size() > 1 ? listedFiles(given.assembly) : first, title, scenes::drawnParts(scene),
          given.assembly};
}

void readWishes(const CheckArguments& given, scenes::CheckSettings& settings) {
  for (const std::string& pair : given.between)
    settings.between.push_back(scenes::pairFromText(pair, "--between"));
  for (const std::string& pair : given.ignored)
    settings.ignored.push_back(scenes::pairFromText(pair, "--ignore"));
  settings.overlaps.is_strict = given.is_strict;
  if (!given.rules.empty()) {
    settings.rules = scenes::loadRules(given.rules);
    settings.overlaps.rules = scenes::loadOverlapRules(given.rules);
  }
  if (given.min_gap.empty()) return;
  scenes::CheckRule& gap = settings.rules.emplace_back();
  gap.name = "--min-gap";
  gap.min_clearance_m = scenes::lengthFromText(given.min_gap, "--min-gap");
  if (!(*gap.min_clearance_m > 0))
    throw LoadError("", "", "--min-gap is " + given.min_gap + "; expected more than 0");
}

Assembly readAssembly(const CheckArguments& given, const Progress& progress) {
  return areCadFiles(given.assembly) ? readCad(given, progress) : readScene(given, progress);
}

/// The new revision, read as the old one is.
Assembly readNewRevision(CheckArguments given, const Progress& progress) {
  given.assembly = given.against;
  return readAssembly(given, progress);
}

std::vector<scenes::SectionPlane> planesFrom(const CheckArguments& given) {
  if (!given.sections.empty() && given.html.empty() && given.pdf.empty())
    throw LoadError("", "", "--section draws into the page; give --html FILE or --pdf FILE as well");
  std::vector<scenes::SectionPlane> planes;
  for (const std::string& text : given.sections)
    planes.push_back(scenes::sectionPlaneFromText(text, "--section"));
  return planes;
}

/// What changed since the old revision, which is checked with the settings of the new one, without pictures.
scenes::RevisionChanges changesSince(const Assembly& old_revision, scenes::CheckSettings settings,
                                     const scenes::CheckedAssembly& after, const Progress& progress) {
  settings.has_sections = settings.has_maps = false;
  settings.planes.clear();
  const scenes::CheckResult before =
      scenes::checkAssembly(old_revision.name, old_revision.parts, settings, progress);
  throwIfStopped();
  return scenes::compareRevisions({old_revision.parts, before}, after, progress);
}

int runCheck(const CheckArguments& given) {
  std::vector<std::string> inputs = given.assembly;
  if (!given.rules.empty()) inputs.push_back(given.rules);
  inputs.insert(inputs.end(), given.against.begin(), given.against.end());
  OutputFile json(given.json, inputs), csv(given.csv, inputs), html(given.html, inputs);
  PdfFile pdf(given.pdf, inputs);
  scenes::CheckSettings settings;
  settings.has_play = !given.has_no_play;
  settings.has_places = true;
  settings.has_sections = settings.has_maps = !given.html.empty() || !given.pdf.empty();
  if (!given.near.empty()) settings.near_m = scenes::lengthFromText(given.near, "--near");
  if (!(settings.near_m >= 0)) throw LoadError("", "", "--near is " + given.near + "; expected 0 or more");
  settings.planes = planesFrom(given);
  readWishes(given, settings);
  std::vector<scenes::PartMove> moves;
  for (const std::string& move : given.moves) moves.push_back(scenes::partMoveFromText(move, "--move"));
  ProgressBar bar;
  Assembly assembly = readAssembly(given, bar.progress()), old_revision;
  if (!given.against.empty()) old_revision = std::exchange(assembly, readNewRevision(given, bar.progress()));
  for (const std::string& output : {given.json, given.csv, given.html, given.pdf}) {
    requireNotRead(output, assembly.read);
    requireNotRead(output, old_revision.read);
  }
  scenes::moveParts(assembly.parts, moves, "--move");
  for (const scenes::SectionPlane& plane : settings.planes) scenes::requireCut(plane, assembly.parts);
  scenes::CheckResult result = scenes::checkAssembly(assembly.name, assembly.parts, settings, bar.progress());
  result.title = assembly.title;
  throwIfStopped();
  std::optional<scenes::RevisionChanges> changes;
  if (!given.against.empty())
    changes = changesSince(old_revision, settings, {assembly.parts, result}, bar.progress());
  json.write(toJson(result, changes ? &*changes : nullptr));
  csv.write(checkCsv(result));
  const std::string page = checkPage(result, changes ? revisionSection(*changes) : "", bar.progress());
  html.write(page);
  bar.clear();
  std::fputs(checkTables(result).c_str(), stdout);
  std::printf("%s\n", checkHeadline(result).c_str());
  if (changes) std::fputs(revisionTables(*changes).c_str(), stdout);
  pdf.write(page);  // printed last, so that a failure loses no other result
  return scenes::exitStatusOf(scenes::answerOf(result));
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
      .add_option(
          "--rules", given->rules,
          "file of rules (TOML): bounds of clearance, overlap and axis offset for pairs of parts, and "
          "overlaps that are threads, seals or inserts")
      ->type_name("FILE");
  command.add_flag("--strict-overlaps", given->is_strict,
                   "count threads that are drawn as cylinders, squashed seals and inserts as clashes, unless "
                   "the scene or the file of rules declares them");
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
  command
      .add_option("--against", given->against,
                  "new revision of the assembly, as CAD or scene file; the first argument is then the old "
                  "one. Reports what changed from old to new; all results and the exit status are those of "
                  "the new revision. Several CAD files: give the option several times")
      ->type_name("CAD|SCENE")
      ->allow_extra_args(false);
  command
      .add_option("--section", given->sections,
                  "draw all parts cut by a plane into the page: z=12mm, x=-3mm, or a normal as in "
                  "0:0.7:0.7=12mm; in the axes after --up; may be given several times; needs --html or --pdf")
      ->type_name("PLANE")
      ->allow_extra_args(false);
  command.add_option("--csv", given->csv, "CSV file with one number and its error on each line")
      ->type_name("FILE");
  command.add_option("--html", given->html, "write an HTML page with tables")->type_name("FILE");
  addPdfOption(command, given->pdf);
  addJsonOption(command, given->json);
  return [given] { return runCheck(*given); };
}

}  // namespace vps::viewer
