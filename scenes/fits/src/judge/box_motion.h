// SPDX-License-Identifier: BSD-3-Clause
// The greatest displacement of any point of a part.
#pragma once

#include <algorithm>

#include "vps/mesh.h"

namespace vps::scenes {

/// Greatest displacement of any point of a box that moves from X_a to X_b: a corner's, since it is convex in
/// the point.
inline double greatestDisplacement(const Box& box, const Pose& X_a, const Pose& X_b) {
  double greatest_m = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1) ? box.max.x() : box.min.x(), (corner & 2) ? box.max.y() : box.min.y(),
                 (corner & 4) ? box.max.z() : box.min.z());
    greatest_m = std::max(greatest_m, (X_b * p - X_a * p).norm());
  }
  return greatest_m;
}

}  // namespace vps::scenes
