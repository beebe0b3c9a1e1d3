// SPDX-License-Identifier: BSD-3-Clause
// A scene whose parts are off their size or their place.
#pragma once

#include <vector>

#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Moves every face of a part outwards by `by_m`, or inwards for a negative one, and removes its models. The
/// other parts stay as they are.
void growPart(ScenePart& part, double by_m);

/// The scene whose step's part is larger by `by_m` on every face. What stood on a seat now stands higher by
/// that much, so that its path and its target are moved back by it, against the last leg of the path.
Scene withGrownStep(const Scene& scene, std::size_t step, double by_m);

/// How far a part is off.
struct PartDeviation {
  double growth_m = 0;             ///< of every face, outwards
  double friction = 0;             ///< added to that of its material
  Vec3 move_P_m = Vec3::Zero();    ///< of its place, in its own frame
  Vec3 turn_P_rad = Vec3::Zero();  ///< about its origin
  [[nodiscard]] bool isDisplaced() const { return !move_P_m.isZero() || !turn_P_rad.isZero(); }
  [[nodiscard]] Pose X_PE() const;
};

/// The scene with each part off by its deviation. A fixed part stands, and one that a step moves belongs,
/// where it is displaced to. Along the last leg of its path a part stops where its seat is: there its target
/// follows the size, the displacement and the tilt of the parts that are in place, the one that is highest,
/// so that only deviations across the path can be in its way.
Scene withDeviations(const Scene& scene, const std::vector<PartDeviation>& deviations);

}  // namespace vps::scenes
