// SPDX-License-Identifier: BSD-3-Clause
// Nearest points of two triangles.
#pragma once

#include <array>

#include "vps/mesh_distance.h"

namespace vps::scenes {

using Triangle = std::array<Vec3, 3>;

/// The nearest points of two triangles. Features are numbered as in TrianglePoint: 0 the face, 1 to 3 edges,
/// 4 to 6 corners.
struct TriangleGap {
  double distance_m = 0;  ///< 0 where the triangles cross
  Vec3 p_a = Vec3::Zero(), p_b = Vec3::Zero();
  int feature_a = 0, feature_b = 0;
};

/// The distance of two triangles, exact to rounding: the least of 9 distances of edges and 6 distances of
/// corners from faces, or 0 if an edge of one triangle crosses the other.
TriangleGap triangleGap(const Triangle& a, const Triangle& b);

/// The nearest points of segments ab and cd, as fractions of the segments. Source: Ericson, Real-Time
/// Collision Detection, section 5.1.9.
std::array<double, 2> nearestOfSegments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Distance of the origin of the plane from a triangle, which may have no area; 0 inside.
double distanceOfOrigin(const std::array<Eigen::Vector2d, 3>& corners);

}  // namespace vps::scenes
