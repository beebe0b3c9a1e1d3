// SPDX-License-Identifier: BSD-3-Clause
// The direction in which a step brings its part home.
#pragma once

#include "vps_scenes/scene.h"

namespace vps::scenes::inline v0 {

/// Of the last leg of the path of G, unit, in W. Zero where the part only turns there.
inline Vec3 insertionAxis(const SceneStep& step, const Pose& X_PG) {
  constexpr double kLeast_m = 1e-9;
  const Vec3 last_W = step.way_points.empty() ? step.X_WP_start * X_PG.p : step.way_points.back() * X_PG.p;
  const Vec3 leg_W = step.X_WP_target * X_PG.p - last_W;
  return leg_W.norm() < kLeast_m ? Vec3(Vec3::Zero()) : Vec3(leg_W.normalized());
}

}  // namespace vps::scenes::inline v0
