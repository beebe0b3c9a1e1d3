// SPDX-License-Identifier: BSD-3-Clause
// The main job: runs an assembly procedure with a device and an operator, in lockstep or in real time, once
// or with several seeds of the virtual operator.
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

struct TrySettings {
  int tries = 10;        ///< number of seeds to run, at least 1
  unsigned threads = 0;  ///< number of tries that run at the same time; 0: one for each core
};

/// Runs the procedure with `tries` seeds. Returns the result of the first seed whose run fits, or else of the
/// first seed, with `tries` and `ease_share` filled in: one success shows that the parts go together, and the
/// share of successes shows how easily. Where geometry proves that a part is blocked, only the first seed is
/// run. Seeds start at scene.hand.seed and increase by scene.steps.size(), since each step of a run takes the
/// next seed. Results have the same bits for any number of threads, except for wall times. Throws as
/// assemble(), and LoadError for a run in real time, for a device that a person moves and for fewer tries
/// than one.
VPS_SCENES_API AssembleResult assembleTries(const Scene& scene, const TrySettings& settings,
                                            const AssembleOptions& options = {});

}  // namespace vps::scenes
