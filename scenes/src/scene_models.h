// SPDX-License-Identifier: BSD-3-Clause
// Builds what a scene's parts lack: voxmaps and pointshells at the scene's fidelity.
#pragma once

#include "vps_scenes/model_options.h"
#include "vps_scenes/result.h"
#include "vps_scenes/scene.h"

namespace vps {

VoxMapSettings voxMapSettings(const Fidelity& fidelity);
PointShellSettings pointShellSettings(const Fidelity& fidelity);

/// Gives every part its voxmap and pointshell. Parts of equal geometry share one of each. Throws LoadError
/// naming the file and part that cannot be modelled.
void buildModels(Scene& scene, const ModelOptions& options);

/// What the models cost; shared ones count once.
ModelledCost modelledCost(const Scene& scene);

}  // namespace vps
