// SPDX-License-Identifier: BSD-3-Clause
#include "models/scene_models.h"

#include <set>

#include "core/wall_clock.h"
#include "vps/crop.h"
#include "vps/load_error.h"
#include "vps/mesh_repair.h"

namespace vps::scenes {

namespace {

/// Builds a part's map, or takes it from the cache.
std::shared_ptr<const VoxMap> mapOf(const ScenePart& part, const VoxMapSettings& settings,
                                    const ModelOptions& options) {
  const std::string& name = part.part.name;
  MeshReport report;
  auto map = std::make_shared<VoxMap>(options.cache != nullptr
                                          ? options.cache->build(part.part.mesh, settings, name, {}, &report)
                                          : buildVoxMap(part.part.mesh, settings, name, {}, &report));
  if (report.signed_by_winding && options.warn)
    options.warn(part.file + ": part '" + name + "' is no closed surface: " + describe(report));
  return map;
}

}  // namespace

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

void forgetCropped(ScenePart& scene_part) {
  if (!scene_part.is_cropped) return;
  scene_part.part.map.reset();
  scene_part.part.shell.reset();
  scene_part.is_cropped = false;
}

void crop(ScenePart& scene_part, const std::vector<Box>& kept_P) {
  if (kept_P.empty()) return;
  Part& part = scene_part.part;
  if (part.map) part.map = std::make_shared<VoxMap>(croppedVoxMap(*part.map, kept_P));
  if (part.shell) part.shell = std::make_shared<PointShell>(croppedShell(*part.shell, kept_P));
  scene_part.is_cropped = true;
}

BuildTimes buildPart(ScenePart& scene_part, const PlannedPart& planned, const Fidelity& fidelity,
                     const ModelOptions& options) {
  Part& part = scene_part.part;
  BuildTimes times;
  double begun_s = wallSeconds();
  if (planned.has_map && !part.map) part.map = mapOf(scene_part, voxMapSettings(fidelity), options);
  times.map_wall_s = wallSeconds() - begun_s;
  begun_s = wallSeconds();
  if (planned.has_shell && !part.shell)
    part.shell =
        std::make_shared<PointShell>(buildPointShell(part.mesh, pointShellSettings(fidelity), part.name));
  crop(scene_part, planned.kept_P);
  times.shell_wall_s = wallSeconds() - begun_s;
  return times;
}

}  // namespace

std::vector<BuildTimes> buildModels(Scene& scene, const Plan& plan, const ModelOptions& options) {
  if (scene.fidelity_wish)
    throw LoadError(scene.file, "",
                    "asks for an automatic fidelity that was not chosen yet; call resolveFidelity() first");
  const Progress& progress = options.progress;
  std::vector<BuildTimes> times(scene.parts.size());
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    ScenePart& part = scene.parts[i];
    if (progress)
      progress("modelling " + part.part.name,
               static_cast<double>(i) / static_cast<double>(scene.parts.size()));
    requireUsable(part.part.mesh, part.file, part.part.name);
    forgetCropped(part);
    if (const auto same_as = plan.parts[i].same_as) {
      part.part.map = scene.parts[*same_as].part.map;
      part.part.shell = scene.parts[*same_as].part.shell;
    } else {
      times[i] = buildPart(part, plan.parts[i], scene.fidelity, options);
    }
  }
  if (progress) progress("modelling", 1);
  return times;
}

void buildModels(Scene& scene, const ModelOptions& options) {
  buildModels(scene, makeSharingPlan(scene), options);
}

void buildWhole(Scene& scene, Plan& plan, const ModelOptions& options) {
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    PlannedPart& planned = plan.parts[i];
    planned.kept_P.clear();
    if (scene.parts[i].is_fixed) planned.has_map = planned.has_shell = true;
  }
  for (PlannedStep& step : plan.steps) {
    step.region_W.reset();
    step.has_shell = true;
  }
  buildModels(scene, plan, options);
}

ModelledCost modelledCost(const Scene& scene) {
  ModelledCost cost;
  std::set<const void*> seen;
  for (const ScenePart& scene_part : scene.parts) {
    const Part& part = scene_part.part;
    if (part.map && seen.insert(part.map.get()).second) {
      ++cost.voxmaps;
      cost.bytes += part.map->memoryBytes();
    }
    if (part.shell && seen.insert(part.shell.get()).second) {
      ++cost.pointshells;
      cost.points += part.shell->size();
      cost.bytes += part.shell->memoryBytes();
    }
  }
  return cost;
}

}  // namespace vps::scenes
