// SPDX-License-Identifier: BSD-3-Clause
#include "pair/surface_gap.h"

namespace vps::scenes {

SurfaceGap surfaceGap(const PartSurface& a, const PartSurface& b, const Pose& X_AB, double most_m) {
  SurfaceGap best{most_m, {}, {}};
  visitPairs(
      a.tree(), b.tree(), [&](const Box& box) { return moved(box, X_AB); },
      [](const Box& of_a, const Box& of_b) { return distance2(of_a, of_b); },
      [&] { return best.distance_m * best.distance_m; },
      [&](std::uint32_t i, std::uint32_t k) {
        const Triangle of_a = a.triangle(i), of_b = b.triangle(k);
        const TriangleGap gap = triangleGap(of_a, {X_AB * of_b[0], X_AB * of_b[1], X_AB * of_b[2]});
        if (gap.distance_m < best.distance_m) best = {gap.distance_m, gap.p_a, gap.p_b};
      });
  return best;
}

}  // namespace vps::scenes
