// SPDX-License-Identifier: BSD-3-Clause
#include "work/planned_folder.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "input/part_file_name.h"
#include "input/stl.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/plan_report.h"
#include "output/table.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps/write_file.h"
#include "vps_scenes/planning/plan.h"
#include "vps_scenes/scene/scene_text.h"
#include "work/plan_memory.h"

namespace vps::viewer {

namespace {

/// Faces of splines can have a hundred times the triangles of the same faces as cylinders: those of one
/// public bolt have 227,717. The search for ways takes time with their product.
constexpr std::size_t kMostToPlan = 50'000;
constexpr double kCoarsestToPlan_m = 16e-6;

scenes::Scene sceneToPlan(const PlanArguments& given, const Progress& progress) {
  if (!areCadFiles(given.assembly)) {
    requireNoCadOptions(given.assembly.front(), given.cad);
    return loadedScene(given.assembly.front(), given.cad.cache, progress);
  }
  scenes::ImportSettings settings = importSettingsFrom(given.cad, kMostToPlan);
  settings.coarsest_m = kCoarsestToPlan_m;
  return groupedScene(importedCad(given.assembly, settings, given.cad, progress), given.cad);
}

/// Of the product, which comes first, and of each subassembly.
std::string sceneFileName(const scenes::PlanResult& plan, std::size_t i) {
  return i == 0 ? "scene.toml" : plan.assemblies[i].name + ".toml";
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
        file = partFileName(part.part.name, meshExtension(part.part.mesh, part.part.face_colors), taken);
        requireNotRead((std::filesystem::path(given.out) / file).string(), read);
        out.write(file, meshBytes(part.part.mesh, part.part.face_colors));
      }
      files.push_back(file);
    }
    const std::string name = sceneFileName(plan, i);
    requireNotRead((std::filesystem::path(given.out) / name).string(), read);
    const std::string comment =
        "Planned from " + listedFiles(given.assembly) +
        (i == 0 ? "; run it with vps assemble." : ": a subassembly, which scene.toml mounts as one part.");
    out.write(name, scenes::sceneText(planned[i], files, comment));
  }
}

/// Of the files as they are written.
std::vector<scenes::WayFault> faultsOf(const scenes::PlanResult& plan, const OutputFolder& out,
                                       const Progress& progress) {
  std::vector<scenes::WayFault> faults;
  for (std::size_t i = 0; i < plan.assemblies.size(); ++i) {
    const scenes::Scene scene =
        scenes::loadScene((std::filesystem::path(out.partial()) / sceneFileName(plan, i)).string());
    for (const scenes::WayFault& fault : checkWays(scene, progress)) faults.push_back(fault);
  }
  return faults;
}

/// Plans; what it had found when it is stopped is kept in the folder.
scenes::PlanResult planned(const PlanArguments& given, const scenes::Scene& scene,
                           scenes::PlanSettings settings, ProgressBar& bar) {
  const std::string unfinished = (std::filesystem::path(given.out) / kUnfinishedPlan).string();
  const std::string key = planKey(scene, settings);
  std::optional<scenes::PlanFindings> known;
  if (given.is_resumed) {
    known = readFindings(unfinished, key);
    if (!known) say("no " + unfinished + ": there is nothing to resume, and all is planned");
  }
  scenes::PlanFindings found;
  if (known) settings.known = &*known;
  settings.found = &found;
  try {
    return planAssembly(scene, settings, bar.progress());
  } catch (const Stopped&) {
    bar.clear();
    if (!found.motions.empty() || !found.taken_off.empty()) {
      writeWholeFile(unfinished, findingsText(key, found));
      std::printf("stopped with %zu motions known and %zu parts or sets taken off", found.motions.size(),
                  found.taken_off.size());
      for (std::size_t i = 0; i < found.taken_off.size(); ++i)
        std::printf("%s'%s'", i == 0 ? ": " : ", ", found.taken_off[i].c_str());
      std::printf("; kept in %s, go on with --resume\n", unfinished.c_str());
    }
    throw;
  }
}

}  // namespace

void addPlanOptions(CLI::App& command, PlanArguments& given) {
  command.add_option("--base", given.bases, "a part that stands still, by name; may be given several times")
      ->type_name("NAME");
  command.add_flag("--bench", given.has_bench,
                   "lay the parts out around the base; each is lifted over everything to where it goes");
  command.add_flag("--resume", given.is_resumed,
                   "go on where an earlier plan into the same folder was stopped (Ctrl-C)");
}

PlannedFolder planInto(const PlanArguments& given, ProgressBar& bar) {
  std::error_code error;
  if (!given.is_forced && std::filesystem::exists(std::filesystem::path(given.out) / "scene.toml", error))
    throw LoadError(given.out, "",
                    "has a scene.toml already; choose another folder, or replace it with --force");
  OutputFolder out(given.out);
  OutputFile json(given.json, given.assembly);
  const scenes::Scene scene = sceneToPlan(given, bar.progress());
  for (const std::string& warning : scene.warnings)
    warn(given.assembly.size() > 1 ? warning : given.assembly.front() + ": " + warning);
  scenes::PlanSettings settings;
  settings.fixed = given.bases;
  settings.has_bench = given.has_bench;
  const scenes::PlanResult plan = planned(given, scene, settings, bar);
  std::vector<std::string> read = given.assembly;
  for (const scenes::ScenePart& part : scene.parts) read.push_back(part.file);
  std::vector<scenes::Scene> planned_scenes = plannedScenes(scene, plan);
  for (scenes::Scene& one : planned_scenes) {
    bar.progress()("choosing voxels", 1);
    const std::string words = fitFidelity(one);
    if (words.empty()) continue;
    bar.clear();
    say(one.name + ": " + words);
  }
  writeScenes(given, planned_scenes, plan, read, out);
  const std::vector<scenes::WayFault> faults = faultsOf(plan, out, bar.progress());
  throwIfStopped();
  out.write("plan.dot", planDot(plan));
  out.write("plan.svg", planSvg(plan));
  out.write("plan.json", toJson(plan, faults));
  out.commit();
  std::filesystem::remove(std::filesystem::path(given.out) / kUnfinishedPlan, error);
  json.write(toJson(plan, faults));
  bar.clear();
  std::fputs(planTables(plan).c_str(), stdout);
  for (const scenes::WayFault& fault : faults) warn(inWords(fault));
  std::printf("%s; scene: %s/scene.toml\n", planHeadline(plan).c_str(), given.out.c_str());
  // The planner has said already what nothing carries.
  const bool is_free = std::ranges::all_of(
      faults, [](const scenes::WayFault& fault) { return fault.kind == scenes::WayFaultKind::Support; });
  PlannedFolder folder{plan.blocked() > 0 || !is_free ? kBad : kGood, plan.steps(), {}};
  for (std::size_t i = 0; i < plan.assemblies.size(); ++i)
    folder.scene_files.push_back({(std::filesystem::path(given.out) / sceneFileName(plan, i)).string(),
                                  !plan.assemblies[i].steps.empty()});
  return folder;
}

}  // namespace vps::viewer
