// SPDX-License-Identifier: BSD-3-Clause
// Decides which face a corner touches when it passes the edge between two faces within the rest gap. The
// direction between corner and edge does not tell: a corner that slides flush over an edge would be stopped
// by it.
#pragma once

#include <cstdint>
#include <span>

#include "vps/feature_set.h"
#include "vps/pose.h"

namespace vps {

enum class BorderOwner {
  Facet,      ///< the corner passes the neighbour's plane above the facet, and is then over the facet
  Neighbour,  ///< the corner passes the facet's plane above the neighbour, and is then over the neighbour
  Edge,       ///< neither: the corner touches the edge, or the facet within its border
};

/// A corner of another part that passes a facet's border, in the frame of the facet's part.
struct PassingCorner {
  Vec3 r;                      ///< the corner relative to the facet's nearest point
  Vec3 way;                    ///< the corner's displacement relative to the facet
  std::span<const Vec3> rays;  ///< FeatureSet::raysAt(), in the frame of the corner's part
  Mat3 R;                      ///< rotation from the frame of the corner's part to that of the facet's part
};

/// Decides which feature of `part` the corner touches. A neighbour that the corner's own surface keeps it
/// from touching is left out.
/// @param q  the facet's nearest point, in the part's frame
/// @param tolerated_m  how far below the face the corner may pass the other face's plane
BorderOwner ownerAtBorder(const FeatureSet& part, std::uint32_t facet, const Vec3& q,
                          const PassingCorner& corner, double tolerated_m);

}  // namespace vps
