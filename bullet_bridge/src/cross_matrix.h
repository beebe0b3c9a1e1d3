// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vps/pose.h"

namespace vps {

/// The matrix [r] for which [r] x is the cross product of r and x.
inline Mat3 crossMatrix(const Vec3& r) {
  Mat3 m;
  m << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return m;
}

}  // namespace vps
