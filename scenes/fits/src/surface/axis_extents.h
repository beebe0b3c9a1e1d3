// SPDX-License-Identifier: BSD-3-Clause
// How far the nodes of a tree are from an axis of rotation, and where along it: turning changes neither.
#pragma once

#include <array>
#include <vector>

#include "surface/part_surface.h"

namespace vps::scenes {

struct AxisExtent {
  double from_m = 1e300, to_m = -1e300;      ///< along the axis, from its centre
  double nearest_m = 1e300, farthest_m = 0;  ///< from the axis

  void add(const AxisExtent& other);
  /// Whether what turns about the axis, and is moved along it by something between the two distances, can
  /// come within this distance of the other.
  [[nodiscard]] bool reaches(const AxisExtent& other, double within_m,
                             const std::array<double, 2>& along_m = {}) const {
    return from_m + along_m[0] <= other.to_m + within_m && other.from_m <= to_m + along_m[1] + within_m &&
           nearest_m <= other.farthest_m + within_m && other.nearest_m <= farthest_m + within_m;
  }
};

/// Of a triangle, around an axis with two unit vectors across it.
AxisExtent axisExtent(const Triangle& t, const Vec3& center, const Vec3& axis, const Vec3& u, const Vec3& v);

/// Of each node and each triangle of a part; the axis is in the part's frame. O(n).
struct AxisExtents {
  std::vector<AxisExtent> nodes, triangles;
  AxisExtents(const PartSurface& part, const Vec3& axis, const Vec3& center);
};

}  // namespace vps::scenes
