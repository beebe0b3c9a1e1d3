// SPDX-License-Identifier: BSD-3-Clause
// Scenes whose parts deviate in size or placement.
#pragma once

#include <vector>

#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Moves every face of one part outwards by `by_m`, or inwards if it is negative, and removes the part's
/// models.
void growPart(ScenePart& part, double by_m);

/// The scene with the step's part larger by `by_m` on every face. A part that stands on a seat then stands
/// higher by this amount, so its path and its target are moved back by it, against the last leg of the path.
Scene withGrownStep(const Scene& scene, std::size_t step, double by_m);

/// Deviation of one part from the drawing.
struct PartDeviation {
  double growth_m = 0;             ///< offset of every face, outwards
  double friction = 0;             ///< added to the friction of its material
  Vec3 move_P_m = Vec3::Zero();    ///< displacement, in its own frame
  Vec3 turn_P_rad = Vec3::Zero();  ///< rotation about its origin, in its own frame
  [[nodiscard]] bool isDisplaced() const { return !move_P_m.isZero() || !turn_P_rad.isZero(); }
  [[nodiscard]] Pose X_PE() const;
};

/// The scene with each part changed by its deviation. For a fixed part the displacement applies to its pose,
/// for a moved part to its target. Along the last leg of its path a part stops at its seat: there its target
/// follows the size, displacement and tilt of the highest part in place, so that only deviations across the
/// path can block it.
Scene withDeviations(const Scene& scene, const std::vector<PartDeviation>& deviations);

}  // namespace vps::scenes
