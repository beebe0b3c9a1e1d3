// SPDX-License-Identifier: BSD-3-Clause
// Builds what a scene's parts lack: voxmaps and pointshells at the scene's fidelity.
#pragma once

#include "vps_scenes/model_options.h"
#include "vps_scenes/plan.h"
#include "vps_scenes/result.h"
#include "vps_scenes/scene.h"

namespace vps::scenes {

VoxMapSettings voxMapSettings(const Fidelity& fidelity);
PointShellSettings pointShellSettings(const Fidelity& fidelity);

/// True for meshes with the same vertices and triangles, to the bit.
bool isEqualGeometry(const Mesh& a, const Mesh& b);

/// What a part's own models took; 0 where it has none, or shares them.
struct BuildTimes {
  double map_wall_s = 0, shell_wall_s = 0;
};

/// Gives every part the voxmap and pointshell that the plan says, where it has none. Throws LoadError naming
/// the file and part that cannot be modelled.
std::vector<BuildTimes> buildModels(Scene& scene, const Plan& plan, const ModelOptions& options);

/// Whole models for every part that lacks them; equal ones are shared.
void buildModels(Scene& scene, const ModelOptions& options);

/// For a run that comes to the border of the plan's regions: whole models for what was left out or cropped,
/// and a plan without regions.
void buildWhole(Scene& scene, Plan& plan, const ModelOptions& options);

/// What the models cost; shared ones count once.
ModelledCost modelledCost(const Scene& scene);

}  // namespace vps::scenes
