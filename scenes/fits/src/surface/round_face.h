// SPDX-License-Identifier: BSD-3-Clause
// Cylindrical faces of a part, from the facets of its mesh.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vps/pose.h"

namespace vps::scenes {

class PartSurface;

/// A cylinder without ends.
struct Cylinder {
  Vec3 axis = Vec3::UnitZ();  ///< unit
  Vec3 p = Vec3::Zero();      ///< point on the axis
  double radius_m = 0;

  /// The vector from the axis to x, perpendicular to the axis.
  [[nodiscard]] Vec3 outward(const Vec3& x) const {
    const Vec3 d = x - p;
    return d - axis.dot(d) * axis;
  }
  /// Distance of x from the surface, negative inside.
  [[nodiscard]] double off(const Vec3& x) const { return outward(x).norm() - radius_m; }
};

/// Fits a cylinder to points: minimises the sum of their squared distances from it, by Gauss-Newton.
/// `cylinder` holds a guess and receives the result. Returns false if the iteration fails; `cylinder` may
/// have changed then. O(points).
bool fitCylinder(std::span<const Vec3> points, Cylinder& cylinder);

/// Facets whose corners lie on one cylinder. The corners lie on the true surface, so the radius is free of
/// the facets' chord error.
struct RoundFace {
  Vec3 axis = Vec3::UnitZ();  ///< unit, in the part's frame
  Vec3 p = Vec3::Zero();      ///< point on the axis
  double radius_m = 0;
  double from_m = 0, to_m = 0;        ///< along the axis, from p
  double residual_m = 0;              ///< greatest distance of a corner from the cylinder
  bool is_bore = false;               ///< whether the material is outside the cylinder
  std::vector<std::uint32_t> facets;  ///< ascending
};

/// Finds the cylindrical faces that cover at least three tenths of a turn. Coarse cylinders, whose facets
/// meet at more than kCurved_rad, count as prisms and are not found. O(n).
std::vector<RoundFace> roundFaces(const PartSurface& surface);

}  // namespace vps::scenes
