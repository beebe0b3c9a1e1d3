// SPDX-License-Identifier: BSD-3-Clause
// Exact distance to Bullet's analytic shapes.
#pragma once

#include "vps/pose.h"

class btCollisionShape;

namespace vps::bullet {

/// Signed distance [m], negative inside, and the outward unit normal there.
struct SurfaceDistance {
  double distance_m = 0;
  Vec3 n = Vec3::Zero();
  bool is_edge = false;  ///< the nearest point is on a sharp edge or corner
};

/// True for plane, box, sphere, capsule, cylinder, cone, multi-sphere (of up to 12 spheres, scaled evenly),
/// a btUniformScalingShape of one of those by a positive factor, and a NativeShape that stands for one.
bool isPrimitive(const btCollisionShape& shape);

/// True for the primitives that have corners or rims: box, cylinder, cone. A shell's points can straddle
/// those.
bool hasCorners(const btCollisionShape& shape);

/// Distance from p (in the shape's frame) to the solid that the shape stands for. Requires
/// isPrimitive(shape). Bullet's box and cylinder include their margin in the size, so that is the size taken.
/// Its cone is given without, and is taken as given: the margin that Bullet rounds it by is not seen.
/// O(1); for n spheres O(n^4).
SurfaceDistance primitiveDistance(const btCollisionShape& shape, const Vec3& p);

}  // namespace vps::bullet
