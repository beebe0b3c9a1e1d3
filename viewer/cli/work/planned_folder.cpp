// SPDX-License-Identifier: BSD-3-Clause
#include "work/planned_folder.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "input/mesh_file.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/reports.h"
#include "output/table.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps/write_file.h"
#include "vps_scenes/fits/check.h"
#include "vps_scenes/fits/rules.h"
#include "vps_scenes/planning/plan.h"
#include "vps_scenes/scene/number_words.h"
#include "vps_scenes/scene/scene_text.h"
#include "work/book_file.h"

namespace vps::viewer {

namespace {

using nlohmann::json;

/// A 64-bit FNV-1a hash.
class Key {
 public:
  void add(const void* data, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i)
      key_ = (key_ ^ static_cast<const unsigned char*>(data)[i]) * 0x100000001b3ULL;
  }
  void add(const std::string& text) { add(text.c_str(), text.size() + 1); }
  void add(double x) { add(&x, sizeof x); }
  [[nodiscard]] std::string text() const { return std::to_string(key_); }

 private:
  std::uint64_t key_ = 0xcbf29ce484222325ULL;
};

std::optional<json> jsonOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  return json::parse(in, nullptr, false);
}

/// A hash of the parts, their poses and the settings of the plan.
std::string planKey(const scenes::Scene& scene, const scenes::PlanSettings& settings) {
  constexpr int kForm = 1;  // version of the format of PlanFindings::motions
  Key key;
  key.add(kForm);
  for (const scenes::DrawnPart& part : drawnParts(scene)) {
    key.add(part.name);
    key.add(part.mesh.vertices.data(), part.mesh.vertices.size() * sizeof part.mesh.vertices[0]);
    key.add(part.mesh.triangles.data(), part.mesh.triangles.size() * sizeof part.mesh.triangles[0]);
    for (const double x : {part.X_WP.p.x(), part.X_WP.p.y(), part.X_WP.p.z()}) key.add(x);
    for (int i = 0; i < 9; ++i) key.add(part.X_WP.R(i / 3, i % 3));
    for (const double x : {part.chord_m.value_or(-1), part.press_fit_m, part.rounding_m}) key.add(x);
    key.add(part.allow_overlap ? 1.0 : 0.0);
  }
  for (const scenes::ScenePart& part : scene.parts) key.add(part.is_scenery ? 1.0 : 0.0);
  for (int axis = 0; axis < 3; ++axis) key.add(scene.gravity_W[axis]);
  for (const std::string& name : settings.fixed) key.add(name);
  key.add(settings.overlaps.is_strict ? 1.0 : 0.0);
  for (const scenes::OverlapRule& rule : settings.overlaps.rules) {
    for (const std::string& text : {rule.between.a, rule.between.b}) key.add(text);
    key.add(static_cast<int>(rule.kind));
    key.add(rule.max_squash.value_or(-1));
  }
  return key.text();
}

std::string findingsText(const std::string& key, const scenes::PlanFindings& found) {
  return json{{"parts", key}, {"taken_off", found.taken_off}, {"motions", found.motions}}.dump() + "\n";
}

std::optional<scenes::PlanFindings> readFindings(const std::string& file, const std::string& key) {
  const std::optional<json> all = jsonOf(file);
  if (!all) return std::nullopt;
  try {
    if (all->at("parts").get<std::string>() != key)
      throw LoadError(file, "", "belongs to other parts or another base; delete it, or leave out --resume");
    return scenes::PlanFindings{all->at("motions").get<std::vector<std::uint64_t>>(),
                                all->at("taken_off").get<std::vector<std::string>>()};
  } catch (const json::exception&) {
    throw LoadError(file, "", "is damaged; delete it, or leave out --resume");
  }
}

/// Faces that are splines can have a hundred times as many triangles as the same faces as cylinders; one
/// public bolt has 227,717 triangles. The time of the search for paths grows with the product of the numbers
/// of triangles of two parts.
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

/// Name of the scene file of the i-th assembly; the first assembly is the product.
std::string sceneFileName(const scenes::PlanResult& plan, std::size_t i) {
  return i == 0 ? "scene.toml" : plan.assemblies[i].name + ".toml";
}

/// Writes scene.toml, a scene file named after each subassembly, and the meshes.
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

/// Faults of the paths, read from the scene files as they were written.
std::vector<scenes::WayFault> faultsOf(const scenes::PlanResult& plan, const OutputFolder& out,
                                       const Progress& progress) {
  std::vector<scenes::WayFault> faults;
  for (std::size_t i = 0; i < plan.assemblies.size(); ++i) {
    const scenes::Scene scene =
        scenes::loadScene((std::filesystem::path(out.partial()) / sceneFileName(plan, i)).string(), progress);
    for (const scenes::WayFault& fault : checkWays(scene, progress)) faults.push_back(fault);
  }
  return faults;
}

/// What a plan has found so far, which stays in the folder if the program is stopped before the plan is
/// written.
class Unfinished {
 public:
  /// Refers to the settings, which name this object's findings afterwards. With --resume they get the
  /// findings of an earlier plan. Throws LoadError if those belong to other parts or are damaged.
  Unfinished(const PlanArguments& given, const scenes::Scene& scene, scenes::PlanSettings& settings)
      : file_((std::filesystem::path(given.out) / kUnfinishedPlan).string()), key_(planKey(scene, settings)) {
    if (given.is_resumed) {
      known_ = readFindings(file_, key_);
      if (!known_) say("no " + file_ + ": there is nothing to resume, so the whole assembly is planned");
    }
    if (known_) settings.known = &*known_;
    settings.found = &found_;
  }

  /// After a stop.
  void keep() const {
    if (found_.motions.empty() && found_.taken_off.empty()) return;
    writeWholeFile(file_, findingsText(key_, found_));
    std::printf("stopped with %s known and %s taken off",
                scenes::counted(found_.motions.size(), "motion").c_str(),
                scenes::counted(found_.taken_off.size(), "part or set", "parts or sets").c_str());
    for (std::size_t i = 0; i < found_.taken_off.size(); ++i)
      std::printf("%s'%s'", i == 0 ? ": " : ", ", found_.taken_off[i].c_str());
    std::printf("; kept in %s, continue with --resume\n", file_.c_str());
  }

 private:
  std::string file_, key_;
  std::optional<scenes::PlanFindings> known_;
  scenes::PlanFindings found_;
};

struct WrittenPlan {
  scenes::PlanResult plan;
  std::vector<scenes::WayFault> faults;
};

/// Plans the scene and writes all files of the plan into the folder, without out.commit().
WrittenPlan planAndWrite(const PlanArguments& given, const scenes::Scene& scene,
                         const scenes::PlanSettings& settings, const OutputFolder& out, ProgressBar& bar) {
  WrittenPlan written{planAssembly(scene, settings, bar.progress()), {}};
  std::vector<std::string> read = given.assembly;
  for (const scenes::ScenePart& part : scene.parts) read.push_back(part.file);
  std::vector<scenes::Scene> planned_scenes = plannedScenes(scene, written.plan);
  for (scenes::Scene& one : planned_scenes) {
    bar.progress()("choosing voxels", 1);
    const std::string words = fitFidelity(one);
    if (words.empty()) continue;
    bar.clear();
    say(one.name + ": " + words);
  }
  writeScenes(given, planned_scenes, written.plan, read, out);
  written.faults = faultsOf(written.plan, out, bar.progress());
  throwIfStopped();
  out.write("plan.dot", planDot(written.plan));
  out.write("plan.svg", planSvg(written.plan));
  out.write("plan.json", toJson(written.plan, written.faults));
  return written;
}

}  // namespace

void addPlanOptions(CLI::App& command, PlanArguments& given) {
  command.add_option("--base", given.bases, "name of a part that does not move; may be given several times")
      ->type_name("NAME");
  command.add_flag("--bench", given.has_bench,
                   "lay the parts out around the base; each is lifted over all others to its place");
  command.add_flag("--resume", given.is_resumed,
                   "continue an earlier plan into the same folder that was stopped (Ctrl-C)");
  command
      .add_option("--rules", given.rules,
                  "file of rules (TOML), of which [[overlap]] counts: which overlaps are threads, seals or "
                  "inserts")
      ->type_name("FILE");
  command.add_flag("--strict-overlaps", given.is_strict,
                   "count threads that are drawn as cylinders, squashed seals and inserts as clashes, unless "
                   "the scene or the file of rules declares them");
}

PlannedFolder planInto(const PlanArguments& given, ProgressBar& bar) {
  std::error_code error;
  if (!given.is_forced && std::filesystem::exists(std::filesystem::path(given.out) / "scene.toml", error))
    throw LoadError(given.out, "",
                    "has a scene.toml already; choose another folder, or replace it with --force");
  OutputFolder out(given.out);
  OutputFile json(given.json, given.assembly);
  BookFile book(given.book, given.assembly);
  const scenes::Scene scene = sceneToPlan(given, bar.progress());
  for (const std::string& warning : scene.warnings)
    warn(given.assembly.size() > 1 ? warning : given.assembly.front() + ": " + warning);
  scenes::PlanSettings settings;
  settings.fixed = given.bases;
  settings.has_bench = given.has_bench;
  settings.overlaps.is_strict = given.is_strict;
  if (!given.rules.empty()) settings.overlaps.rules = scenes::loadOverlapRules(given.rules);
  const Unfinished unfinished(given, scene, settings);
  WrittenPlan written;
  try {
    written = planAndWrite(given, scene, settings, out, bar);
  } catch (const Stopped&) {
    bar.clear();
    unfinished.keep();
    throw;
  }
  const auto& [plan, faults] = written;
  out.commit();
  std::filesystem::remove(std::filesystem::path(given.out) / kUnfinishedPlan, error);
  json.write(toJson(plan, faults));
  bar.clear();
  std::fputs(planTables(plan).c_str(), stdout);
  for (const scenes::WayFault& fault : faults) warn(inWords(fault));
  std::printf("%s; scene: %s/scene.toml\n", planHeadline(plan, faults).c_str(), given.out.c_str());
  book.write(scene, plan, !areCadFiles(given.assembly), bar);
  PlannedFolder folder{verdictOf(plan, faults), plan.steps(), {}, {}};
  for (std::size_t i = 0; i < plan.assemblies.size(); ++i) {
    folder.scene_files.push_back({(std::filesystem::path(given.out) / sceneFileName(plan, i)).string(),
                                  !plan.assemblies[i].steps.empty()});
    for (const scenes::BlockedPart& part : plan.assemblies[i].blocked)
      if (!part.enclosed_by.empty()) folder.enclosed.push_back(part);
  }
  return folder;
}

std::map<std::string, double> plannedClearances(const std::string& scene_file) {
  const std::filesystem::path path(scene_file);
  const std::optional<json> plan = jsonOf((path.parent_path() / "plan.json").string());
  std::map<std::string, double> out;
  if (!plan || plan->is_discarded()) return out;
  try {
    const json& assemblies = plan->at("assemblies");
    const bool is_product = path.filename() == "scene.toml";
    for (std::size_t i = 0; i < assemblies.size(); ++i) {
      const json& assembly = assemblies[i];
      if (is_product ? i != 0 : assembly.at("name").get<std::string>() != path.stem().string()) continue;
      for (const json& step : assembly.at("steps")) {
        const json& clearance = step.at("clearance_m");
        out[step.at("name").get<std::string>()] =
            clearance.is_null() ? scenes::kNearWay_m : clearance.get<double>();
      }
    }
  } catch (const json::exception&) {
    return {};  // another program wrote plan.json
  }
  return out;
}

}  // namespace vps::viewer
