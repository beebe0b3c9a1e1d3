// SPDX-License-Identifier: BSD-3-Clause
// The main job: runs an assembly procedure with a device and an operator, in lockstep or in real time.
#pragma once

#include <atomic>

#include "vps_scenes/export.h"
#include "vps_scenes/model_options.h"
#include "vps_scenes/result.h"
#include "vps_scenes/scene.h"

namespace vps::scenes {

struct AssembleOptions : ModelOptions {
  bool keep_going = true;  ///< place a part that failed at its target and go on with the next step
  /// The exact judge looks at every so many poses of a step, and always at the fifty with the deepest
  /// contacts. Changes only max_penetration_m and what goes with it.
  std::size_t judge_stride = 20;
  const std::atomic<bool>* stop = nullptr;  ///< set it to end early; the result then says "stopped"
  /// Records the run there (vps_device/recorder.h says how), scene and meshes included, so that
  /// vps_scenes/replay.h runs it again from this file alone; empty: not. A run that is stopped or fails
  /// leaves what it recorded beside it, and says where by `warn`.
  std::string record;
  /// The haptic loop on a thread of its own, by the system's clock, and physics beside it by the same, from
  /// the first step to the last: a step is judged and the next one's field cooked on other threads meanwhile.
  /// Not repeatable; recorded it is, since a recording holds what the two knew of each other.
  bool is_real_time = false;
  /// In real time a run that cannot hold its physics rate gives up what pace.h says, in its order, and takes
  /// it back when it can. False: it only counts what it missed. Lockstep never gives up anything.
  bool degrades = true;
  /// What else the physics thread does after each step; a run's own time_s. Null: nothing.
  std::function<void(double time_s)> after_step;
  /// Between physics steps the haptic loop works out the part's motion by itself
  /// (vps_device/local_contact.h). For physics slower than the loop. Not with `record`. In real time the loop
  /// stops where a part is taken and let go.
  bool has_local_contact = false;
};

/// Builds what the scene requires and lacks (plan.h), then runs every step: the hand moves the device's
/// handle, the handle's proxy pulls the part, contact decides where it goes; it is released, watched for
/// scene.release_s, and cooked into the fixed voxmap. Simulated time on one thread, unless
/// is_real_time: the same scene gives the same bits but for wall times. Throws LoadError for a scene that
/// cannot be run (a part that starts inside another, a mesh that cannot be modelled). A step that does not
/// reach its target is a result, not an error.
VPS_SCENES_API AssembleResult assemble(Scene& scene, const AssembleOptions& options = {});

}  // namespace vps::scenes
