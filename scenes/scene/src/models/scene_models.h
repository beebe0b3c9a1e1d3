// SPDX-License-Identifier: BSD-3-Clause
// Builds the models of a scene's parts at the scene's fidelity, according to a model plan.
#pragma once

#include "vps_scenes/scene/model_options.h"
#include "vps_scenes/scene/model_plan.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

VoxMapSettings voxMapSettings(const Fidelity& fidelity);
PointShellSettings pointShellSettings(const Fidelity& fidelity);
/// The scene's fidelity, with the voxel and spacing of this part's own models.
Fidelity fidelityOf(const ScenePart& part, const Fidelity& fidelity);

/// Time to build one part's own models; 0 if the part has no models or shares those of another part.
struct BuildTimes {
  double map_wall_s = 0, shell_wall_s = 0;
};

/// A mesh with the same facets, each moved inwards by the given distance, or outwards if the distance is
/// negative: the surface of a part that is pressed in, or whose size deviates from the drawn size. If the
/// facets at a corner have no common point at that distance, the corner moves to the point with the least
/// squares of the deviations. The function is meant for distances far below the size of the facets.
Mesh shrunkMesh(const Mesh& mesh, double by_m);

/// Whether a step of the plan has the part in its fixed field.
bool isCooked(const ModelPlan& plan, std::size_t part);

/// Throws LoadError, with a voxel that fits, if a voxmap of the plan exceeds the greatest size of a voxmap,
/// or all models together exceed the memory of the options or of this machine. The check estimates memory
/// from the areas of the meshes, and builds no models. O(triangles).
void requireModelsFit(const Scene& scene, const ModelPlan& plan, const ModelOptions& options);

/// Sets ScenePart::model of every part of the plan. Keeps a voxmap, pointshell or surface that a part already
/// has, unless it is cropped. Parts are built in parallel, with the same bits on any number of cores;
/// progress is called by one thread at a time. Throws LoadError naming the file and the first part that
/// cannot be modelled.
std::vector<BuildTimes> buildModels(Scene& scene, const ModelPlan& plan, const ModelOptions& options);

/// Builds the models of `parts` (indices, ascending) only. No other part may share the models of a part in
/// this list.
std::vector<BuildTimes> buildModels(Scene& scene, const ModelPlan& plan, std::vector<std::size_t> parts,
                                    const ModelOptions& options);

/// Builds complete models of every part; parts of equal geometry share models.
void buildModels(Scene& scene, const ModelOptions& options);

/// Builds complete models of all fixed parts and removes the regions from the plan, for a run whose part
/// reaches the border of its region.
void buildWhole(Scene& scene, ModelPlan& plan, const ModelOptions& options);

/// Number and memory of the models of all parts; shared models count once.
ModelledCost modelledCost(const Scene& scene);

}  // namespace vps::scenes
