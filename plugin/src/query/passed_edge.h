// SPDX-License-Identifier: BSD-3-Clause
// Which face a corner meets that passes within the rest gap of the edge between two faces. The direction
// between corner and edge says nothing there: a corner that slides flush over an edge would be stopped by it.
#pragma once

#include "vps/feature_set.h"

namespace vps::inline v0 {

enum class BorderOwner {
  Facet,      ///< the corner passes the neighbour's plane above the facet, and is then over it
  Neighbour,  ///< the reverse
  Edge,       ///< neither: the corner meets the edge, or the facet within its border
};

/// @param q    the facet's nearest point, in the part's frame
/// @param r    the corner minus q
/// @param way  of the corner relative to the facet
/// @param tolerated_m  how far below the face the corner may pass the other face's plane
BorderOwner ownerAtBorder(const FeatureSet& part, std::uint32_t facet, const Vec3& q, const Vec3& r,
                          const Vec3& way, double tolerated_m);

}  // namespace vps::inline v0
