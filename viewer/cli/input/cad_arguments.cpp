// SPDX-License-Identifier: BSD-3-Clause
#include "input/cad_arguments.h"

#include <CLI/CLI.hpp>

#include "input/file_kind.h"
#include "input/scene_arguments.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps_scenes/planning/plan.h"
#include "vps_scenes/scene/number_words.h"
#include "vps_scenes/scene/scene_parts.h"
#include "vps_scenes/scene/scene_text.h"

namespace vps::viewer {

bool CadArguments::isAny() const {
  return !units.empty() || !deflection.empty() || !up.empty() || !part_per.empty() || time_limit_s > 0 ||
         !groups.names.empty() || has_no_groups;
}

void addCadOptions(CLI::App& command, CadArguments& given) {
  addUnitsOption(command, given.units);
  addDeflectionOption(command, given.deflection);
  command
      .add_option("--up", given.up, "axis of the file that points up and becomes z: x, -x, y, -y, z or -z")
      ->type_name("AXIS");
  command
      .add_option("--part-per", given.part_per,
                  "what becomes one part: body: each solid or closed surface; object: also each open object, "
                  "group or shape; file: each file")
      ->type_name("THING")
      ->check(CLI::IsMember({"body", "object", "file"}));
  command
      .add_option("--group", given.groups.names,
                  "assembly or product of the file, or part names with *, whose parts become one body; may "
                  "be given several times")
      ->type_name("NAME");
  command.add_flag("--no-groups", given.has_no_groups,
                   "find no groups except those of --group; each solid is a part");
  command
      .add_option(
          "--time-limit", given.time_limit_s,
          "stop after this many seconds of reading all files and welding their meshes; vps import also "
          "counts the repair of the meshes and the search for fasteners")
      ->type_name("SECONDS")
      ->check(CLI::PositiveNumber);
}

scenes::ImportSettings importSettingsFrom(const CadArguments& given, std::size_t most_triangles) {
  scenes::ImportSettings settings;
  settings.unit_m = unitFrom(given.units);
  settings.guesses_up = true;
  settings.most_s = given.time_limit_s;
  if (given.part_per == "object") settings.part_per = scenes::PartPer::Object;
  if (given.part_per == "file") settings.part_per = scenes::PartPer::File;
  settings.most_triangles = most_triangles;
  if (!given.deflection.empty()) {
    settings.deflection_m = scenes::lengthFromText(given.deflection, "--deflection");
    settings.most_triangles = 0;
  }
  if (!(settings.deflection_m > 0))
    throw LoadError("", "", "--deflection is " + given.deflection + "; expected more than 0");
  if (!given.up.empty()) {
    settings.up = scenes::axisFromText(given.up);
    if (!settings.up)
      throw LoadError("", "", "--up is '" + given.up + "'; expected one of: x, -x, y, -y, z, -z");
  }
  return settings;
}

scenes::ImportedCad importedCad(const std::vector<std::string>& files, scenes::ImportSettings settings,
                                const CadArguments& given, const Progress& progress) {
  const std::optional<ByteCache> cache = cadCacheFrom(given.cache);
  settings.cache = cache ? &*cache : nullptr;
  scenes::ImportedCad cad = scenes::importCad(files, settings, progress);
  if (settings.unit_m && cad.states_unit)
    cad.warnings.push_back(std::string(files.size() > 1 ? "each file " : "") + kUnusedUnits);
  return cad;
}

bool areCadFiles(const std::vector<std::string>& files) {
  if (files.size() == 1 && !scenes::isCadExtension(lowerExtension(files.front()))) return false;
  for (const std::string& file : files) {
    if (files.size() > 1 && lowerExtension(file) == ".toml")
      throw LoadError(file, "",
                      "is a scene, which must be the only file; several files are CAD parts of one assembly");
    requireCadFile(file);
  }
  return true;
}

std::string listedFiles(const std::vector<std::string>& files) {
  std::string out;
  for (const std::string& file : files) out += (out.empty() ? "" : ", ") + scenes::tomlText(file);
  return out;
}

std::vector<scenes::PartGroup> groupsOf(scenes::ImportedCad& cad, const CadArguments& given) {
  scenes::GroupWishes wishes = given.groups;
  wishes.is_proposed = !given.has_no_groups;
  std::vector<scenes::PartGroup> groups = scenes::partGroups(cad, wishes);
  for (const scenes::PartGroup& group : groups)
    say("group '" + group.name + "': " + scenes::counted(group.parts.size(), "part is", "parts are") +
        " one body (" + group.reason + ")" +
        (group.reason == "asked for" ? "" : "; --no-groups keeps them apart"));
  return groups;
}

scenes::Scene groupedScene(scenes::ImportedCad cad, const CadArguments& given) {
  const std::vector<scenes::PartGroup> groups = groupsOf(cad, given);
  scenes::Scene scene = scenes::sceneOf(cad);
  uniteGroups(scene, groups);
  return scene;
}

void requireNoCadOptions(const std::string& scene, const CadArguments& given) {
  requireOwnUnits(scene, given.units, given.deflection);
  if (given.isAny())
    throw LoadError(scene, "",
                    "is a scene, which states its groups and poses itself; leave out --up, --part-per, "
                    "--group, --no-groups and --time-limit");
}

}  // namespace vps::viewer
