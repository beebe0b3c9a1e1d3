// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/fits/resized.h"

namespace vps::scenes {

void resize(Mesh& mesh, const Resized& to) {
  constexpr double kOn = 1e-3;  // distance from the cylinder, relative to the radius
  const bool is_wider = to.to_radius_m > to.from_radius_m;
  const double reach_m = is_wider ? 0.1 * to.from_radius_m : to.from_radius_m;
  for (Vec3& x : mesh.vertices) {
    const double along_m = to.axis.dot(x - to.p);
    if (along_m < to.from_m - reach_m || along_m > to.to_m + reach_m) continue;
    const Vec3 out = x - to.p - along_m * to.axis;
    const double radius_m = out.norm();
    const bool is_moved = is_wider ? radius_m < to.to_radius_m && radius_m > (1 - kOn) * to.from_radius_m
                                   : radius_m > to.to_radius_m && radius_m < (1 + kOn) * to.from_radius_m;
    if (is_moved) x += (to.to_radius_m / radius_m - 1) * out;
  }
}

}  // namespace vps::scenes
