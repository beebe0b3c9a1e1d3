// SPDX-License-Identifier: BSD-3-Clause
// The main job: runs an assembly procedure with a device and an operator, in lockstep or in real time.
#pragma once

#include "vps_scenes/export.h"
#include "vps_scenes/run/assemble_options.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Builds the models that the scene requires and lacks (model_plan.h), then runs every step: the hand moves
/// the device's handle, the handle's proxy pulls the part through the coupling, and contact decides where the
/// part goes. The part is released, watched for scene.release_s, and cooked into the fixed field. Unless
/// is_real_time is set, the run uses simulated time on one thread, and the same scene gives the same bits
/// except for wall times. Throws LoadError for a scene that cannot be run (a part that starts inside another,
/// a mesh that cannot be modelled). A step that does not reach its target is a result, not an error.
VPS_SCENES_API AssembleResult assemble(Scene& scene, const AssembleOptions& options = {});

}  // namespace vps::scenes
