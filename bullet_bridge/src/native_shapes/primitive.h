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
  bool is_edge = false;       ///< the nearest point is on a sharp edge or corner
  std::uint16_t surface = 0;  ///< of a Shape: index of the surface that it is from
};

/// True for plane, box, sphere, capsule, cylinder, cone, multi-sphere (of up to 12 spheres, scaled evenly), a
/// btUniformScalingShape of one of those by a positive factor, and a NativeShapeAdapter of one of those.
bool isPrimitive(const btCollisionShape& shape);

/// True for the primitives that have corners or rims: box, cylinder, cone. These can lie between the points
/// of a shell.
bool hasCorners(const btCollisionShape& shape);

/// Distance from p (in the shape's frame) to the shape's solid. Requires isPrimitive(shape). The size of
/// Bullet's box and cylinder includes their margin; that of the cone does not, and the rounding that Bullet
/// adds to it is ignored. O(1); for n spheres O(n^4).
SurfaceDistance primitiveDistance(const btCollisionShape& shape, const Vec3& p);

}  // namespace vps::bullet
