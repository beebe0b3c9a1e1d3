// SPDX-License-Identifier: BSD-3-Clause
// Errors that the play of fits allows: a part may lean in its fits, and its mates may be displaced in their
// own fits.
#pragma once

#include <cstddef>
#include <vector>

#include "vps_scenes/fits/check_types.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Greatest displacement of a part's surface within the play of its fits. A shaft that is displaced by t from
/// the middle of a hole and leans by w touches the hole at both ends of their common length L where 2 t + w L
/// is the diametral clearance c, so that a point at the distance r from the middle of L moves by t + w r at
/// most: c / 2 without a lean, c r / L without a displacement, and a value between these two for other
/// positions. Parallel fits count as one fit from the first to the last, since the part leans in all of them
/// at once; fits of different directions limit the lean separately. The result is 0 without a fit.
/// @param part    the part as drawn, at its target
/// @param others  the parts that hold it
double leanInFits_m(const DrawnPart& part, const std::vector<DrawnPart>& others);

/// Greatest displacement of the step's part at its target, in the parts that are in place before the step.
double leanInFits_m(const Scene& scene, std::size_t step);

/// Displacements of the mates of this step's part that earlier steps moved: the distance of each mate from
/// its own target, at the middle of the fit, in W. A part with several fits has one entry for each fit. A
/// shaft holds nothing along its axis, and a key holds only across its faces. Each entry is the share of the
/// displacement that the fit passes on. If this share differs from the whole displacement, the whole
/// displacement is a second entry, for a part that rests on a shoulder of its mate.
/// @param X_WP  actual poses of the parts, by part
std::vector<Vec3> displacedMates_m(const Scene& scene, std::size_t step, const std::vector<Pose>& X_WP);

}  // namespace vps::scenes
