// SPDX-License-Identifier: BSD-3-Clause
#include "models/scene_models.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core/wall_clock.h"
#include "models/shrunk_mesh.h"
#include "vps/load_error.h"
#include "vps/mesh_repair.h"
#include "vps/shell_crop.h"
#include "vps/voxmap_crop.h"

namespace vps::scenes::inline v0 {

VoxMapSettings voxMapSettings(const Fidelity& fidelity) {
  VoxMapSettings settings;
  settings.voxel_m = fidelity.voxel_m;
  return settings;
}

PointShellSettings pointShellSettings(const Fidelity& fidelity) {
  PointShellSettings settings;
  settings.spacing_m = fidelity.spacing_m;
  return settings;
}

bool isEqualGeometry(const Mesh& a, const Mesh& b) {
  return a.triangles == b.triangles && a.vertices == b.vertices;
}

namespace {

/// What map and shell are built from, and contacts and overlaps of a run are measured with. A rigid part
/// cannot give way, so that a part that is pressed in has none of its declared interference, half of it on
/// each side, and a little less than the 10 um that count as contact, since without clearance it would jam.
std::shared_ptr<const Solid> solidOf(const ScenePart& part, const Mesh& mesh) {
  constexpr double kPressSlack_m = 8e-6;
  const double by_m = part.press_fit_m > 0 ? 0.5 * part.press_fit_m + kPressSlack_m : 0;
  return std::make_shared<const Solid>(by_m > 0 ? shrunkMesh(mesh, by_m) : mesh, part.part.name);
}

/// Builds a part's map, or takes it from the cache.
std::shared_ptr<const VoxMap> mapOf(const ScenePart& part, const Solid& solid, const VoxMapSettings& settings,
                                    const ModelOptions& options) {
  const std::string& name = part.part.name;
  MeshReport report;
  auto map = std::make_shared<VoxMap>(
      options.cache != nullptr ? options.cache->build(part.press_fit_m > 0 ? solid.mesh() : part.part.mesh,
                                                      solid, settings, name, {}, &report)
                               : buildVoxMap(solid, settings, name, {}, &report));
  if (report.signed_by_winding && options.warn)
    options.warn(part.file + ": part '" + name + "' is not a closed surface: " + describe(report));
  return map;
}

/// What is still valid of the models that the part has, or of `shared`, which is the model of a part of equal
/// geometry. Name and material are always the part's own.
PartModel startingModel(const ScenePart& scene_part, const PartModel* shared) {
  const PartModel* from = shared != nullptr ? shared : scene_part.model.get();
  PartModel model = from != nullptr ? *from : PartModel{};
  if (shared == nullptr && scene_part.is_cropped) {
    model.map.reset();
    model.shell.reset();
  }
  model.name = scene_part.part.name;
  model.material = scene_part.part.material;
  if (!model.mesh) model.mesh = std::make_shared<const Mesh>(scene_part.part.mesh);
  return model;
}

void crop(PartModel& model, const std::vector<Box>& kept_P) {
  if (model.map) model.map = std::make_shared<VoxMap>(croppedVoxMap(*model.map, kept_P));
  if (model.shell) model.shell = std::make_shared<PointShell>(croppedShell(*model.shell, kept_P));
}

bool isCooked(const ModelPlan& plan, std::size_t part) {
  return std::ranges::any_of(
      plan.steps, [part](const FieldPlan& step) { return std::ranges::count(step.cooked, part) > 0; });
}

BuildTimes buildPart(ScenePart& scene_part, const PartModelPlan& planned, const Fidelity& fidelity,
                     const ModelOptions& options, PartModel& model) {
  BuildTimes times;
  double begun_s = wallSeconds();
  if (planned.has_map && !model.map)
    model.map = mapOf(scene_part, *model.solid, voxMapSettings(fidelity), options);
  times.map_wall_s = wallSeconds() - begun_s;
  begun_s = wallSeconds();
  if (planned.has_shell && !model.shell)
    model.shell = std::make_shared<PointShell>(
        buildPointShell(*model.solid, pointShellSettings(fidelity), scene_part.part.name));
  scene_part.is_cropped = !planned.kept_P.empty();
  if (scene_part.is_cropped) crop(model, planned.kept_P);
  times.shell_wall_s = wallSeconds() - begun_s;
  return times;
}

}  // namespace

std::vector<BuildTimes> buildModels(Scene& scene, const ModelPlan& plan, const ModelOptions& options) {
  if (scene.fidelity_wish)
    throw LoadError(scene.file, "",
                    "asks for an automatic fidelity that was not chosen yet; call resolveFidelity() first");
  const Progress& progress = options.progress;
  std::vector<BuildTimes> times(scene.parts.size());
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    ScenePart& part = scene.parts[i];
    const PartModelPlan& planned = plan.parts[i];
    if (progress)
      progress("modelling " + part.part.name,
               static_cast<double>(i) / static_cast<double>(scene.parts.size()));
    requireUsable(part.part.mesh, part.file, part.part.name);
    const bool is_modelled = planned.has_map || planned.has_shell || isCooked(plan, i);
    if (!is_modelled && !part.model) continue;
    PartModel model =
        startingModel(part, planned.same_as ? scene.parts[*planned.same_as].model.get() : nullptr);
    if (is_modelled && !model.solid) model.solid = solidOf(part, *model.mesh);
    if (planned.same_as)
      part.is_cropped = false;
    else
      times[i] = buildPart(part, planned, scene.fidelity, options, model);
    part.model = std::make_shared<const PartModel>(std::move(model));
  }
  if (progress) progress("modelling", 1);
  return times;
}

void buildModels(Scene& scene, const ModelOptions& options) {
  buildModels(scene, makeSharedModelPlan(scene), options);
}

void buildWhole(Scene& scene, ModelPlan& plan, const ModelOptions& options) {
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    PartModelPlan& planned = plan.parts[i];
    planned.kept_P.clear();
    if (scene.parts[i].is_fixed) planned.has_map = planned.has_shell = true;
  }
  for (FieldPlan& step : plan.steps) {
    step.region_W.reset();
    step.has_shell = true;
  }
  buildModels(scene, plan, options);
}

ModelledCost modelledCost(const Scene& scene) {
  ModelledCost cost;
  std::set<const void*> seen;
  for (const ScenePart& part : scene.parts) {
    if (!part.model) continue;
    const PartModel& model = *part.model;
    if (model.map && seen.insert(model.map.get()).second) {
      ++cost.voxmaps;
      cost.bytes += model.map->memoryBytes();
    }
    if (model.shell && seen.insert(model.shell.get()).second) {
      ++cost.pointshells;
      cost.points += model.shell->size();
      cost.bytes += model.shell->memoryBytes();
    }
  }
  return cost;
}

}  // namespace vps::scenes::inline v0
