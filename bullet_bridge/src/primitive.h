// SPDX-License-Identifier: BSD-3-Clause
// Exact distance to Bullet's analytic shapes.
#pragma once

#include "vps/pose.h"

class btCollisionShape;

namespace vps {

/// Signed distance [m], negative inside, and the outward unit normal there.
struct SurfaceDistance {
  double distance_m = 0;
  Vec3 n = Vec3::Zero();
  bool is_edge = false;  ///< the nearest point is on a sharp edge or corner
};

/// True for plane, box, sphere, capsule and cylinder.
bool isPrimitive(const btCollisionShape& shape);

/// Distance from p (in the shape's frame) to the solid that the shape stands for. Requires
/// isPrimitive(shape). Bullet's box and cylinder include their margin in the size, so that is the size taken.
SurfaceDistance primitiveDistance(const btCollisionShape& shape, const Vec3& p);

}  // namespace vps
