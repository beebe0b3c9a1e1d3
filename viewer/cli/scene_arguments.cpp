// SPDX-License-Identifier: BSD-3-Clause
// What the commands make of the arguments that several of them share: a scene, a fidelity, a cache.
#include "commands.h"
#include "output.h"
#include "progress_bar.h"
#include "terminal.h"
#include "vps/load_error.h"
#include "vps_scenes/fidelity_choice.h"
#include "vps_scenes/import.h"

namespace vps::viewer {

namespace {

void readLength(const std::string& text, const std::string& option, double& out_m) {
  if (text.empty()) return;
  out_m = scenes::lengthFromText(text, option);
  if (!(out_m > 0)) throw LoadError("", "", option + " is " + text + "; expected more than 0");
}

}  // namespace

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

std::optional<VoxMapCache> cacheFrom(const std::string& folder) {
  if (folder.empty()) return std::nullopt;
  return VoxMapCache(folder, warn);
}

void fill(scenes::ModelOptions& options, ProgressBar& bar, const std::optional<VoxMapCache>& cache,
          bool models_everything) {
  options.progress = bar.progress();
  options.cache = cache ? &*cache : nullptr;
  options.warn = warn;
  options.models_everything = models_everything;
}

scenes::Scene sceneFrom(const std::string& file, const FidelityArguments& given,
                        const std::vector<std::string>& outputs) {
  scenes::Scene scene = scenes::loadScene(file);
  std::vector<std::string> read;
  for (const scenes::ScenePart& part : scene.parts) read.push_back(part.file);
  if (!scene.device.data.empty()) read.push_back(scene.device.data);
  for (const std::string& output : outputs) requireNotRead(output, read);
  for (const std::string& warning : scene.warnings) warn(warning);
  scenes::resolveFidelity(scene);
  const Fidelity own = scene.fidelity;
  scene.fidelity = fidelityFrom(given, own);
  if (scene.fidelity_choice.empty()) return scene;
  if (scene.fidelity.voxel_m == own.voxel_m && scene.fidelity.spacing_m == own.spacing_m) {
    say("chosen: " + scene.fidelity_choice);
    return scene;
  }
  // The command line overrides the choice, so its models are of no use.
  scene.fidelity_choice.clear();
  for (scenes::ScenePart& part : scene.parts) {
    part.part.map.reset();
    part.part.shell.reset();
  }
  return scene;
}

}  // namespace vps::viewer
