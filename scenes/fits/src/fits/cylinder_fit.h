// SPDX-License-Identifier: BSD-3-Clause
// The cylinder that is nearest to points.
#pragma once

#include <span>

#include "vps/pose.h"

namespace vps::scenes {

struct Cylinder {
  Vec3 axis = Vec3::UnitZ();  ///< unit
  Vec3 p = Vec3::Zero();      ///< on the axis
  double radius_m = 0;

  /// From the axis to x.
  [[nodiscard]] Vec3 outward(const Vec3& x) const {
    const Vec3 d = x - p;
    return d - axis.dot(d) * axis;
  }
  /// Distance from the surface, negative inside.
  [[nodiscard]] double off(const Vec3& x) const { return outward(x).norm() - radius_m; }
};

/// Gauss-Newton for the least squares of the points' distances, from a cylinder that is near. False where it
/// fails; the cylinder may have moved then. O(points).
bool fitCylinder(std::span<const Vec3> points, Cylinder& cylinder);

}  // namespace vps::scenes
