// SPDX-License-Identifier: BSD-3-Clause
// Tolerances add up in a chain: a ring on an axle that hangs in its hole by its play hangs lower by that.
#pragma once

#include <cstddef>
#include <vector>

#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// How far each part that was moved before, and that this step's part fits, is from its own place at the
/// middle of their fit; in W. Where one part has several fits, each counts. A shaft holds nothing along its
/// axis, and a key only across its faces: first comes what the fit passes on, and then, where it differs, the
/// whole, for a part that stands on its mate's shoulder.
/// @param X_WP  where the parts are, by part
std::vector<Vec3> displacedMates_m(const Scene& scene, std::size_t step, const std::vector<Pose>& X_WP);

}  // namespace vps::scenes
