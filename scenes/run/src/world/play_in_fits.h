// SPDX-License-Identifier: BSD-3-Clause
// How far the play of the fits lets a part be from its place: it may lean in them, and its mates may be
// displaced.
#pragma once

#include <cstddef>
#include <vector>

#include "vps_scenes/fits/check_types.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Greatest displacement of a part's surface within the play of its fits. A shaft that is displaced by t from
/// the middle of a hole and leans by w touches it at both ends of their common length L where 2 t + w L is
/// the diametral clearance c, so that a point at the distance r from the middle of L moves by t + w r at
/// most: c / 2 without a lean, c r / L without a displacement, and between these in between. Parallel fits
/// have the length from the first to the last of them, since the part leans in all at once; fits of other
/// directions each hold it. 0 without a fit.
/// @param part    as drawn, at home
/// @param others  those that hold it
double leanInFits_m(const DrawnPart& part, const std::vector<DrawnPart>& others);

/// Of the step's part at its target, in what is in place by then.
double leanInFits_m(const Scene& scene, std::size_t step);

/// How far each part that was moved before, and that this step's part fits, is from its own place at the
/// middle of their fit; in W. Where one part has several fits, each counts. A shaft holds nothing along its
/// axis, and a key only across its faces: first comes what the fit passes on, and then, where it differs, the
/// whole, for a part that stands on its mate's shoulder.
/// @param X_WP  where the parts are, by part
std::vector<Vec3> displacedMates_m(const Scene& scene, std::size_t step, const std::vector<Pose>& X_WP);

}  // namespace vps::scenes
