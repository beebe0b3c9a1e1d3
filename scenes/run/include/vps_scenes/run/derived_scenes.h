// SPDX-License-Identifier: BSD-3-Clause
// Scenes made from a scene: its disassembly, what is left of it after some steps, and one part taken in hand
// without a procedure. A run of them is judged, recorded and replayed like any other, and the same scene
// gives the same bits.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

struct PutDown {
  std::size_t part = 0;  ///< index into Scene::parts
  Pose X_WP;
};

/// What is left of a scene's procedure from that step on: what has been put down is fixed there. Each step
/// has the seed that it has in the whole procedure.
/// @param first  at most the number of steps
VPS_SCENES_API Scene sceneFromStep(const Scene& scene, std::size_t first, std::span<const PutDown> before);

/// Where the parts lie at first when they are taken freely: as their steps start, and moved aside along x
/// where their boxes would overlap. One pose for each part.
VPS_SCENES_API std::vector<Pose> laidOut(const Scene& scene);

/// A scene whose only step takes that part from where it lies, never ends by itself, and judges nothing; its
/// target is a hint. All others are fixed where they lie.
/// @param X_WP  of each part
VPS_SCENES_API Scene sceneOfOnePart(const Scene& scene, std::span<const Pose> X_WP, std::size_t part);

/// The scene with all parts in place and its steps in reverse. Each step takes its part off, along its path
/// from the target to the start, and puts it away there (SceneStep::takes_off); a screw is unscrewed first.
/// Nothing guides a part where its path ends, so its tolerance there is kAway_m, or a quarter of a shorter
/// way; that of the assembly does not apply. Throws LoadError for a scene without a step, for one that is a
/// disassembly, and where no part is fixed.
VPS_SCENES_API Scene disassemblyOf(Scene scene);

/// assumed: nearer than this a part that was put away need not be where its way ends
inline constexpr double kAway_m = 2e-3;

}  // namespace vps::scenes
