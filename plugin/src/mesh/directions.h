// SPDX-License-Identifier: BSD-3-Clause
// Directions and the angles between them.
#pragma once

#include <cmath>

#include "vps/pose.h"

namespace vps::inline v0 {

/// Unit v, or zero where v is too short to have a direction.
inline Vec3 unitOrZero(const Vec3& v) {
  const double length = v.norm();
  return length > 0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

/// The angle between u and v; atan2 keeps its accuracy near 0 and pi, where acos loses half the digits.
inline double angleBetween(const Vec3& u, const Vec3& v) {
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

}  // namespace vps::inline v0
