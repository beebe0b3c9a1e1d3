// SPDX-License-Identifier: BSD-3-Clause
#include "judge/surface_error.h"

#include <algorithm>
#include <cmath>

namespace vps::scenes {

double surfaceError_m(const Solid& solid, const Pose& X_error) {
  double greatest_m = 0;
  for (const Vec3& p : solid.mesh().vertices)
    greatest_m = std::max(greatest_m, std::abs(solid.signedDistance(X_error * p)));
  return greatest_m;
}

}  // namespace vps::scenes
