// SPDX-License-Identifier: BSD-3-Clause
// Queries that ask farther than the band of the fields reaches.
#pragma once

#include <vector>

#include "narrowphase/context.h"
#include "narrowphase/pair_view.h"

namespace vps::bullet {

/// The nearest points of two bodies that are within `wanted_m`, measured by the exact surfaces: the nearest
/// place around the nearest shell point of either side, and the points that are farther by no more than a
/// tenth of the spacing. Only the spheres and triangles that can hold them are visited, so the cost hardly
/// depends on `wanted_m`.
std::vector<Candidate> nearestFarPoints(const PairView& pair, double wanted_m, Context& context);

}  // namespace vps::bullet
