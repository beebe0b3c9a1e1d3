// SPDX-License-Identifier: BSD-3-Clause
// Vectors as the arrays of floats that vertex buffers hold.
#pragma once

#include <array>

#include "vps/pose.h"

namespace vps::viewer {

inline std::array<float, 3> toFloat(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

inline Vec3 toVec3(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace vps::viewer
