// SPDX-License-Identifier: BSD-3-Clause
// Unit vectors, angles between directions, and whether a triangle is wide enough to have a normal.
#pragma once

#include <algorithm>
#include <cmath>

#include "vps/pose.h"

namespace vps {

/// v / |v|; zero if v is too short to have a direction.
inline Vec3 unitOrZero(const Vec3& v) {
  const double length = v.norm();
  return length > 0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

/// The angle between u and v. atan2 keeps its accuracy near 0 and pi, where acos loses half the digits.
inline double angleBetween(const Vec3& u, const Vec3& v) {
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

/// False for a triangle so slim that the direction of its normal is rounding error: twice its area is at most
/// this share of its longest edge's square.
inline bool hasArea(const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr double kMinSlimness = 1e-10;
  const double longest2 = std::max({(b - a).squaredNorm(), (c - a).squaredNorm(), (c - b).squaredNorm()});
  return (b - a).cross(c - a).norm() > kMinSlimness * longest2;
}

}  // namespace vps
