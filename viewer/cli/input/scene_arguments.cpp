// SPDX-License-Identifier: BSD-3-Clause
#include "input/scene_arguments.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdlib>

#include "input/file_kind.h"
#include "output/output.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps_scenes/cad/import.h"
#include "vps_scenes/planning/fidelity_choice.h"

namespace vps::viewer {

namespace {

void readLength(const std::string& text, const std::string& option, double& out_m) {
  if (text.empty()) return;
  out_m = scenes::lengthFromText(text, option);
  if (!(out_m > 0)) throw LoadError("", "", option + " is " + text + "; expected more than 0");
}

}  // namespace

void addFidelityOptions(CLI::App& command, FidelityArguments& given) {
  command.add_option("--fidelity", given.preset, "preset: fast, normal or fine");
  command.add_option("--voxel", given.voxel, "grid step of the voxmaps, with unit");
  command.add_option("--spacing", given.spacing, "distance between points of the pointshells, with unit");
  command.add_option(
      "--sides", given.sides,
      "one: points of the moving part in the field of the fixed part; both: the reverse as well");
}

void addPointsOption(CLI::App& command, FidelityArguments& given) {
  command
      .add_option("--points", given.points, "approximate number of pointshell points, instead of --spacing")
      ->excludes(command.get_option("--spacing"))
      ->check(CLI::Range(1, 100000000));
}

Fidelity fidelityFrom(const FidelityArguments& given, Fidelity base) {
  if (!given.preset.empty()) base = fidelityPreset(given.preset);
  readLength(given.voxel, "--voxel", base.voxel_m);
  readLength(given.spacing, "--spacing", base.spacing_m);
  if (!given.sides.empty()) {
    if (given.sides != "one" && given.sides != "both")
      throw LoadError("", "", "--sides is '" + given.sides + "'; expected one or both");
    base.sides = given.sides == "one" ? Sides::One : Sides::Both;
  }
  return base;
}

Fidelity fidelityFrom(const FidelityArguments& given, const NamedMesh& mesh, const NamedMesh* other,
                      std::string& choice) {
  choice.clear();
  Fidelity base = fidelityPreset("normal");
  if (given.preset.empty() && given.voxel.empty()) {
    scenes::Scene scene;
    scene.chooses_voxel = true;
    for (const NamedMesh* named : {&mesh, other}) {
      if (named == nullptr) continue;
      scenes::Part& part = scene.parts.emplace_back().part;
      part.mesh = named->mesh;
      part.name = named->name;
    }
    scenes::chooseResolution(scene);
    choice = scene.resolution_choice;
    const double points_per_voxel = base.spacing_m / base.voxel_m;
    if (const double voxel_m = scene.parts[0].voxel_m; voxel_m > 0)
      base.spacing_m = points_per_voxel * (base.voxel_m = voxel_m);
  }
  return fidelityFrom(given, base);
}

void sayChoice(const std::string& resolution_choice) {
  if (!resolution_choice.empty()) say("chosen by the sizes of the parts: " + resolution_choice);
}

void addSceneArgument(CLI::App& command, std::string& scene) {
  command.add_option("scene", scene, "scene file (TOML)")->required()->type_name("SCENE");
}

void addCacheOption(CLI::App& command, std::string& folder) {
  command.add_option("--cache", folder, "folder in which voxmaps are kept and looked up")->type_name("DIR");
}

void addCacheOptions(CLI::App& command, CacheArguments& given) {
  CLI::Option* folder = command
                            .add_option("--cache", given.folder,
                                        "folder in which models and the parts of CAD files are kept between "
                                        "runs (default: bullet-vps in $XDG_CACHE_HOME or ~/.cache)")
                            ->type_name("DIR");
  command
      .add_flag("--no-cache", given.is_off,
                "build all models and read all CAD files again, and keep none of them")
      ->excludes(folder);
  command
      .add_option("--cache-limit", given.limit_GB,
                  "size limit of the cache folder; the least recently used files are removed")
      ->type_name("GB")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

void addSceneOptions(CLI::App& command, SceneArguments& given) {
  addSceneArgument(command, given.scene);
  command.add_flag("--model-everything", given.models_everything,
                   "build a voxmap and a pointshell of every part, without sharing models of equal parts");
  addFidelityOptions(command, given.fidelity);
  addCacheOptions(command, given.cache);
}

void addDeflectionOption(CLI::App& command, std::string& deflection) {
  command.add_option("--deflection", deflection,
                     "greatest distance between curved faces and their triangles, with unit (STEP, IGES)");
}

void addUnitsOption(CLI::App& command, std::string& units) {
  command.add_option("--units", units, "length unit of files that do not state one: mm, cm, m, um, inch");
}

std::optional<double> unitFrom(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::optional<double> unit_m = scenes::unitFromText(text);
  if (!unit_m) throw LoadError("", "", "--units is '" + text + "'; expected one of: mm, cm, m, um, inch");
  return unit_m;
}

void requireOwnUnits(const std::string& scene, const std::string& units, const std::string& deflection) {
  if (units.empty() && deflection.empty()) return;
  throw LoadError(
      scene, "",
      "is a scene, which states its unit and deflection itself; leave out --units and --deflection");
}

std::optional<VoxMapCache> cacheFrom(const std::string& folder) {
  if (folder.empty()) return std::nullopt;
  return VoxMapCache(folder, warn);
}

namespace {

/// Folder of the cache; empty with --no-cache, or if the user has no folder for caches.
std::string folderOf(const CacheArguments& given) {
  if (given.is_off) return "";
  return given.folder.empty() ? defaultCacheFolder() : given.folder;
}

std::uint64_t limitOf(const CacheArguments& given) {
  constexpr double kMost_GB = 1e9;  // so that the number of bytes fits into 64 bits
  return static_cast<std::uint64_t>(1e9 * std::min(given.limit_GB, kMost_GB));
}

}  // namespace

std::optional<VoxMapCache> cacheFrom(const CacheArguments& given) {
  if (const std::string folder = folderOf(given); !folder.empty())
    return VoxMapCache(folder, warn, limitOf(given));
  return std::nullopt;
}

std::optional<ByteCache> cadCacheFrom(const CacheArguments& given) {
  if (const std::string folder = folderOf(given); !folder.empty())
    return ByteCache(folder, warn, limitOf(given));
  return std::nullopt;
}

std::string defaultCacheFolder() {
  const auto absolute = [](const char* variable) {
    const char* value = std::getenv(variable);
    return value != nullptr && value[0] == '/' ? std::string(value) : std::string();
  };
  if (const std::string caches = absolute("XDG_CACHE_HOME"); !caches.empty()) return caches + "/bullet-vps";
  if (const std::string home = absolute("HOME"); !home.empty()) return home + "/.cache/bullet-vps";
  return "";
}

void setModelOptions(scenes::ModelOptions& options, ProgressBar& bar, const std::optional<VoxMapCache>& cache,
                     bool models_everything) {
  options.progress = bar.progress();
  options.cache = cache ? &*cache : nullptr;
  options.warn = warn;
  options.models_everything = models_everything;
}

scenes::Scene loadedScene(const std::string& file, const CacheArguments& given, const Progress& progress) {
  const std::optional<ByteCache> cache = cadCacheFrom(given);
  return scenes::loadScene(file, progress, cache ? &*cache : nullptr);
}

scenes::Scene sceneFrom(const std::string& file, const FidelityArguments& given,
                        const std::vector<std::string>& outputs, const CacheArguments& cache) {
  requireSceneFile(file);
  ProgressBar bar;
  scenes::Scene scene = loadedScene(file, cache, bar.progress());
  bar.clear();
  std::vector<std::string> read;
  for (const scenes::ScenePart& part : scene.parts) read.push_back(part.file);
  if (!scene.device.data.empty()) read.push_back(scene.device.data);
  for (const std::string& output : outputs) requireNotRead(output, read);
  for (const std::string& warning : scene.warnings) warn(warning);
  // Values from the command line are not chosen automatically.
  if (!given.preset.empty() || !given.voxel.empty()) scene.chooses_voxel = scene.chooses_spacing = false;
  if (!given.spacing.empty()) scene.chooses_spacing = false;
  scenes::resolveFidelity(scene);
  sayChoice(scene.resolution_choice);
  const Fidelity own = scene.fidelity;
  scene.fidelity = fidelityFrom(given, own);
  if (scene.fidelity_choice.empty()) return scene;
  if (scene.fidelity.voxel_m == own.voxel_m && scene.fidelity.spacing_m == own.spacing_m) {
    say("chosen: " + scene.fidelity_choice);
    return scene;
  }
  // The command line overrides the automatic choice, so the models of this choice are of no use.
  scene.fidelity_choice.clear();
  for (scenes::ScenePart& part : scene.parts) part.model.reset();
  return scene;
}

}  // namespace vps::viewer
