// SPDX-License-Identifier: BSD-3-Clause
// vps plan: order and ways of an assembly, as a scene that vps assemble runs.
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <set>

#include "command.h"
#include "file_kind.h"
#include "json_out.h"
#include "output.h"
#include "part_file_name.h"
#include "plan_report.h"
#include "progress_bar.h"
#include "scene_arguments.h"
#include "stl.h"
#include "terminal.h"
#include "vps/load_error.h"
#include "vps_scenes/plan.h"
#include "vps_scenes/scene_text.h"

namespace vps::viewer::inline v0 {

namespace {

struct PlanArguments {
  std::string assembly, out, units, deflection, json;
  std::vector<std::string> bases;
  bool is_forced = false;
  bool is_verify = false;
};

scenes::Scene sceneToPlan(const PlanArguments& given, const Progress& progress) {
  if (!isCadExtension(lowerExtension(given.assembly))) {
    if (!given.units.empty() || !given.deflection.empty())
      throw LoadError(
          given.assembly, "",
          "is a scene, which states its unit and deflection itself; leave out --units and --deflection");
    return scenes::loadScene(given.assembly);
  }
  requireCadFile(given.assembly);
  scenes::ImportSettings settings;
  settings.unit_m = unitFrom(given.units);
  if (!given.deflection.empty())
    settings.deflection_m = scenes::lengthFromText(given.deflection, "--deflection");
  return scenes::sceneOf(scenes::importCad(given.assembly, settings, progress));
}

/// scene.toml, and a scene file named like each subassembly, with the meshes.
void writeScenes(const PlanArguments& given, const std::vector<scenes::Scene>& planned,
                 const scenes::PlanResult& plan, const std::vector<std::string>& read,
                 const OutputFolder& out) {
  std::set<std::string> taken;
  std::map<std::string, std::string> file_of;
  for (std::size_t i = 0; i < planned.size(); ++i) {
    std::vector<std::string> files;
    for (const scenes::ScenePart& part : planned[i].parts) {
      throwIfStopped();
      std::string& file = file_of[part.part.name];
      if (file.empty()) {
        file = partFileName(part.part.name, taken);
        requireNotRead((std::filesystem::path(given.out) / file).string(), read);
        out.write(file, stlBytes(part.part.mesh));
      }
      files.push_back(file);
    }
    const std::string name = i == 0 ? "scene.toml" : plan.assemblies[i].name + ".toml";
    requireNotRead((std::filesystem::path(given.out) / name).string(), read);
    const std::string comment =
        "Planned from " + scenes::tomlText(given.assembly) +
        (i == 0 ? "; run it with vps assemble." : ": a subassembly, which scene.toml mounts as one part.");
    out.write(name, scenes::sceneText(planned[i], files, comment));
  }
}

/// Of the files as they are written.
std::vector<scenes::WayFault> faultsOf(const scenes::PlanResult& plan, const OutputFolder& out,
                                       const Progress& progress) {
  std::vector<scenes::WayFault> faults;
  for (std::size_t i = 0; i < plan.assemblies.size(); ++i) {
    const std::string name = i == 0 ? "scene.toml" : plan.assemblies[i].name + ".toml";
    const scenes::Scene scene = scenes::loadScene((std::filesystem::path(out.partial()) / name).string());
    for (const scenes::WayFault& fault : checkWays(scene, progress)) faults.push_back(fault);
  }
  return faults;
}

int verify(const PlanArguments& given) {
  OutputFile json(given.json, {given.assembly});
  ProgressBar bar;
  requireSceneFile(given.assembly);
  const scenes::Scene scene = scenes::loadScene(given.assembly);
  const std::vector<scenes::WayFault> faults = checkWays(scene, bar.progress());
  throwIfStopped();
  json.write(toJson(scene.name, faults));
  bar.clear();
  for (const scenes::WayFault& fault : faults) std::printf("%s\n", inWords(fault).c_str());
  std::printf("%s: %zu steps, %zu ways lead through parts in place\n", scene.name.c_str(), scene.steps.size(),
              faults.size());
  return faults.empty() ? kGood : kBad;
}

int runPlan(const PlanArguments& given) {
  if (given.is_verify) return verify(given);
  if (given.out.empty()) throw LoadError("", "", "--out is missing; name a folder for the planned scene");
  std::error_code error;
  if (!given.is_forced && std::filesystem::exists(std::filesystem::path(given.out) / "scene.toml", error))
    throw LoadError(given.out, "",
                    "has a scene.toml already; choose another folder, or replace it with --force");
  OutputFolder out(given.out);
  OutputFile json(given.json, {given.assembly});
  ProgressBar bar;
  const scenes::Scene scene = sceneToPlan(given, bar.progress());
  for (const std::string& warning : scene.warnings) warn(given.assembly + ": " + warning);
  scenes::PlanSettings settings;
  settings.fixed = given.bases;
  const scenes::PlanResult plan = planAssembly(scene, settings, bar.progress());
  std::vector<std::string> read{given.assembly};
  for (const scenes::ScenePart& part : scene.parts) read.push_back(part.file);
  writeScenes(given, plannedScenes(scene, plan), plan, read, out);
  const std::vector<scenes::WayFault> faults = faultsOf(plan, out, bar.progress());
  throwIfStopped();
  out.write("plan.dot", planDot(plan));
  out.write("plan.json", toJson(plan, faults));
  out.commit();
  json.write(toJson(plan, faults));
  bar.clear();
  std::fputs(planTables(plan).c_str(), stdout);
  for (const scenes::WayFault& fault : faults) warn(inWords(fault));
  std::printf("%s; scene: %s/scene.toml\n", planHeadline(plan).c_str(), given.out.c_str());
  return plan.blocked() > 0 || !faults.empty() ? kBad : kGood;
}

}  // namespace

void addPlan(CommandLine& line) {
  const auto given = std::make_shared<PlanArguments>();
  CLI::App& command = addCommand(
      line, "plan", "order and ways of an assembly, found by taking it apart; writes a scene",
      "vps plan scenes/bearing_block/bearing_block.step -o planned", [given] { return runPlan(*given); });
  command
      .add_option("assembly", given->assembly,
                  "a CAD file, or a scene file (TOML): its parts at their targets, its steps are replaced")
      ->required()
      ->type_name("CAD|SCENE");
  command.add_option("-o,--out", given->out, "folder for scene.toml, meshes, plan.json and plan.dot")
      ->type_name("DIR");
  command.add_option("--base", given->bases, "a part that stands still, by name; may be given several times")
      ->type_name("NAME");
  addUnitsOption(command, given->units);
  command.add_option("--deflection", given->deflection,
                     "greatest distance between curved faces and their triangles, with unit (STEP, IGES)");
  command.add_flag("--force", given->is_forced, "replace a scene.toml that exists");
  command.add_flag("--verify", given->is_verify,
                   "plan nothing: check that the ways of a scene lead through no part in place");
  addJsonOption(command, given->json);
}

}  // namespace vps::viewer::inline v0
