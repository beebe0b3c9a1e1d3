// SPDX-License-Identifier: BSD-3-Clause
// How far the points of one surface are from another surface.
#pragma once

#include "vps/mesh_distance.h"

namespace vps::scenes {

/// The greatest distance of a point of a surface from another one lies between these bounds.
struct DeviationBounds {
  double low_m = 0;   ///< attained by a point of the surface
  double high_m = 0;  ///< no point is farther
};

/// Bounds the greatest distance of the points of `of` from the surface `from`, to within 1 % or 0.05 um,
/// unless the search ends at its limit of work. `X_FO` is the pose of `of` in the frame of `from`.
///
/// Branch and bound: the distance from one facet of `from` is a convex function, so that on a piece of a
/// facet it is greatest at a corner, and no point of the piece is farther from the whole surface.
DeviationBounds deviation(const Mesh& of, const Pose& X_FO, const MeshDistance& from);

/// The mean distance of `of` from the surface, over its area, estimated at the middles of some facets.
double meanDistance(const Mesh& of, const Pose& X_FO, const MeshDistance& from);

}  // namespace vps::scenes
