// SPDX-License-Identifier: BSD-3-Clause
// Features of curved surfaces that lie flush in each other, as a thread in its nut. Pointshells find these
// contacts, with the normals of the curved surfaces, so that the surfaces slide smoothly.
#pragma once

#include "vps/feature_motion.h"

namespace vps {

/// True for features whose contact is left to pointshells.
/// @param R_10  rotation from the frame of part 0 to that of part 1
/// @param n_1  direction between the features, unit, in the frame of part 1
bool isLeftToPoints(const FeatureSet& part0, const FeatureSet& part1, const FeatureContact& contact,
                    const Mat3& R_10, const Vec3& n_1);

/// Distance of p from the line through side k of a facet; the side runs from corner k to the next.
/// @param p  a point in the part's frame
double distanceToSide(const FeatureSet& part, std::uint32_t facet, std::size_t k, const Vec3& p);

}  // namespace vps
