// SPDX-License-Identifier: BSD-3-Clause
// Cones of directions, which bound the normals of many facets, and the cone of planes that a corner can
// touch.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "vps/contact_tolerances.h"
#include "vps/pose.h"

namespace vps {

/// All directions within an angle of an axis.
struct DirectionCone {
  Vec3 axis = Vec3::UnitZ();  ///< unit
  double angle_rad = std::numbers::pi, cosine = -1, sine = 0;

  static DirectionCone around(const Vec3& axis, double angle_rad) {
    const double angle = std::min(angle_rad, std::numbers::pi);
    return {axis, angle, std::cos(angle), std::sin(angle)};
  }
  static DirectionCone everywhere() { return {}; }

  /// The greatest angle between a direction of the cone and `direction`.
  [[nodiscard]] double farthest_rad(const Vec3& direction) const {
    return std::acos(std::clamp(axis.dot(direction), -1.0, 1.0)) + angle_rad;
  }
};

/// A cone that contains all given cones; everywhere() if there are none. The axis of the result is the mean
/// of the cones' axes.
inline DirectionCone coneOver(std::span<const DirectionCone> cones) {
  Vec3 sum = Vec3::Zero();
  for (const DirectionCone& c : cones) sum += c.axis;
  if (!(sum.norm() > kNoDirection)) return DirectionCone::everywhere();
  const Vec3 axis = sum.normalized();
  double angle_rad = 0;
  for (const DirectionCone& c : cones) angle_rad = std::max(angle_rad, c.farthest_rad(axis));
  return DirectionCone::around(axis, angle_rad);
}

/// True if no direction of cone `a` is within slack_rad of a direction of cone `b`.
/// @param axis  of the first cone, in the frame of the second
inline bool areApart(const DirectionCone& a, const Vec3& axis, const DirectionCone& b, double slack_rad) {
  // cos(alpha + beta + slack) >= cos(alpha + beta) - slack, as long as the angle is less than half a turn.
  return a.angle_rad + b.angle_rad + slack_rad < std::numbers::pi &&
         axis.dot(b.axis) < a.cosine * b.cosine - a.sine * b.sine - slack_rad;
}

/// True if every direction of cone `a` is within angle_rad (up to a quarter turn) of the opposite of every
/// direction of cone `b`.
/// @param axis  of the first cone, in the frame of the second
inline bool areOpposite(const DirectionCone& a, const Vec3& axis, const DirectionCone& b, double angle_rad) {
  const double left_rad = angle_rad - a.angle_rad - b.angle_rad, square = left_rad * left_rad;
  return left_rad > 0 && -axis.dot(b.axis) > 1 - square / 2 + square * square / 24;  // at least the cosine
}

/// True if a corner's surface rises from a plane with normal n all around, or falls from it by no more than
/// the slope. Only such a corner can touch a facet of another part in the plane with normal n: a nut's crest
/// cannot touch the flank from which it faces away. Slopes down to kSinTouch are allowed, since facets only
/// approximate curved surfaces.
/// @param rays  from the corner along its surface, unit; in the normal's frame
inline bool risesFrom(std::span<const Vec3> rays, const Vec3& n, double slope) {
  return std::all_of(rays.begin(), rays.end(), [&](const Vec3& ray) { return n.dot(ray) >= -slope; });
}

/// A cone that contains every unit vector n with n . ray >= -slope for all rays; nothing if there is no such
/// vector. Uses the first twelve rays. O(rays^3).
std::optional<DirectionCone> touchCone(std::span<const Vec3> rays, double slope);

}  // namespace vps
