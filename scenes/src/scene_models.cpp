// SPDX-License-Identifier: BSD-3-Clause
#include "scene_models.h"

#include <set>

#include "vps/load_error.h"
#include "vps/mesh_repair.h"

namespace vps {

namespace {

bool isEqualGeometry(const Mesh& a, const Mesh& b) {
  return a.triangles == b.triangles && a.vertices == b.vertices;
}

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

void buildModels(Scene& scene, const ModelOptions& options) {
  const Progress& progress = options.progress;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    Part& part = scene.parts[i].part;
    if (part.map && part.shell) continue;
    if (progress)
      progress("modelling " + part.name, static_cast<double>(i) / static_cast<double>(scene.parts.size()));
    requireUsable(part.mesh, scene.parts[i].file, part.name);
    for (std::size_t j = 0; j < i; ++j) {
      const Part& other = scene.parts[j].part;
      if (isEqualGeometry(part.mesh, other.mesh)) {
        part.map = other.map;
        part.shell = other.shell;
        break;
      }
    }
    if (!part.map) part.map = mapOf(scene.parts[i], voxMapSettings(scene.fidelity), options);
    if (!part.shell)
      part.shell = std::make_shared<PointShell>(
          buildPointShell(part.mesh, pointShellSettings(scene.fidelity), part.name));
  }
  if (progress) progress("modelling", 1);
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

}  // namespace vps
