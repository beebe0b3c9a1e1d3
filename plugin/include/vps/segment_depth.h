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

/// Deepest point of segment ab, in the solid's frame: no point of it is deeper by certain_m. The ends are
/// measured exactly.
///
/// Where pseudonormals decide what is inside (not isByWinding()), the segment is divided where it crosses the
/// surface, so that a stretch outside costs one search for its nearest point. The depth of a point is at most
/// its distance to any one triangle, which is convex along a segment: a stretch that lies along a face,
/// however long and however near, takes one or two triangles. Of a solid whose sign is a winding number,
/// which may change in a hole where there is no surface, and where the crossings contradict the signs of the
/// stretches, the parts outside are bisected too, as far as the distance, which is 1-Lipschitz, may hide a
/// depth; in the middle of a hole, where it jumps, a point may be missed. O(log triangles) for each face
/// along which the segment lies. Thread-safe. Allocates.
/// @return zero for a sheet, which has no inside, and where an end is not finite
/// @param certain_m  > 0
VPS_API PointDepth deepestOnSegment(const Solid& solid, const Vec3& a, const Vec3& b, double certain_m);

}  // namespace vps
