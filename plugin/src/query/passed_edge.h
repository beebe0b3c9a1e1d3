// SPDX-License-Identifier: BSD-3-Clause
// Which face a corner meets that passes within the rest gap of the edge between two faces. The direction
// between corner and edge says nothing there: a corner that slides flush over an edge would be stopped by it.
#pragma once

#include <cstdint>
#include <span>

#include "vps/feature_set.h"
#include "vps/pose.h"

namespace vps {

enum class BorderOwner {
  Facet,      ///< the corner passes the neighbour's plane above the facet, and is then over it
  Neighbour,  ///< the reverse
  Edge,       ///< neither: the corner meets the edge, or the facet within its border
};

/// A corner of another part that passes a facet's border, in the frame of the facet's part.
struct PassingCorner {
  Vec3 r;                      ///< from the facet's nearest point
  Vec3 way;                    ///< relative to the facet
  std::span<const Vec3> rays;  ///< FeatureSet::raysAt(), in the frame of the corner's part
  Mat3 R;                      ///< from that frame to the facet's part's
};

/// A neighbour that the corner's own surface keeps it from touching meets nothing.
/// @param q  the facet's nearest point, in the part's frame
/// @param tolerated_m  how far below the face the corner may pass the other face's plane
BorderOwner ownerAtBorder(const FeatureSet& part, std::uint32_t facet, const Vec3& q,
                          const PassingCorner& corner, double tolerated_m);

}  // namespace vps
