// SPDX-License-Identifier: BSD-3-Clause
// Overlap that does not depend on how curved faces were divided into facets.
#pragma once

#include "surface/placed_surface.h"

namespace vps::scenes {

struct CertainOverlap {
  double depth_m = 0;  ///< 0: none is certain
  double error_m = 0;  ///< at that place, less than the depth
  Vec3 p_W = Vec3::Zero();
};

/// Of some points of the edges of each part in the other: that whose depth exceeds the error of the facets
/// there by most. The distance of facets from the curved faces that they stand for counts in the direction
/// of the depth only, so that a flat face in a flat face is certain, however coarse the faces beside them
/// are. A search of ends, thirds and middles of the pieces of edges that are inside: what is found is
/// certain, but there may be more. O(edges near the other part x log facets).
CertainOverlap certainOverlap(const PlacedSurface& a, const PlacedSurface& b);

}  // namespace vps::scenes
