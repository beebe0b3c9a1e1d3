// SPDX-License-Identifier: BSD-3-Clause
// Scenes derived from a scene: the disassembly, the remaining steps of its procedure, and one part taken in
// hand without a procedure. A run of a derived scene is judged, recorded and replayed like any other run, and
// the same scene gives the same bits.
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

/// The scene with the steps from `first` on. Parts that were put down before and that no later step moves are
/// fixed where they lie. Each step has the seed that it has in the whole procedure.
/// @param first  at most the number of steps
VPS_SCENES_API Scene sceneFromStep(const Scene& scene, std::size_t first, std::span<const PutDown> before);

/// Initial poses of the parts for a run in which a person takes parts in any order: the start poses of their
/// steps, displaced along x where their boxes would overlap. One pose for each part.
VPS_SCENES_API std::vector<Pose> laidOut(const Scene& scene);

/// A scene whose only step takes the part `part` from where it lies. The step never ends by itself and judges
/// nothing; its target is only shown. All other parts are fixed where they lie.
/// @param X_WP  pose of each part
VPS_SCENES_API Scene sceneOfOnePart(const Scene& scene, std::span<const Pose> X_WP, std::size_t part);

/// The scene with all parts in place and its steps in reverse. Each step takes its part off, along the part's
/// path from the target to the start, and puts the part away at the start (SceneStep::takes_off); a screw is
/// unscrewed first. Nothing guides a part at the end of its path, so the tolerance there is kAway_m, or a
/// quarter of the path's length where that is less. The tolerance of the assembly does not apply. Throws
/// LoadError for a scene without a step, for one that is a disassembly, and where no part is fixed.
VPS_SCENES_API Scene disassemblyOf(Scene scene);

/// Tolerance for a part that was put away. assumed: the place of a part that was put away need not be more
/// exact
inline constexpr double kAway_m = 2e-3;

}  // namespace vps::scenes
