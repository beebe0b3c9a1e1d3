// SPDX-License-Identifier: BSD-3-Clause
// How deep a straight edge is in a solid, by exact distance.
#pragma once

#include "vps/export.h"
#include "vps/solid.h"

namespace vps {

/// A point in a solid, in its frame.
struct PointDepth {
  double depth_m = 0;  ///< distance to the surface; 0 outside
  Vec3 p_S = Vec3::Zero();
};

/// Finds the deepest point of segment ab, in the solid's frame: no point of ab is deeper by more than
/// certain_m. The ends are measured exactly.
///
/// If pseudonormals decide which points are inside (not isByWinding()), the segment is divided where it
/// crosses the surface, so that a piece outside costs one search for its nearest point. The depth of a point
/// is at most its distance to any one triangle, which is convex along a segment: a piece that lies along a
/// face, however long and near, takes one or two triangles. If the sign is a winding number, it may change in
/// a hole, where there is no surface. There, and where the crossings contradict the signs of the pieces, the
/// pieces outside are bisected too, as long as the distance, which is 1-Lipschitz, may hide a depth; in the
/// middle of a hole, where the distance jumps, a point may be missed. O(log triangles) for each face along
/// which the segment lies. Thread-safe. Allocates.
/// @return zero for a sheet, which has no inside, and if an end is not finite
/// @param certain_m  > 0
VPS_API PointDepth deepestOnSegment(const Solid& solid, const Vec3& a, const Vec3& b, double certain_m);

}  // namespace vps
