// SPDX-License-Identifier: BSD-3-Clause
// The direction in which a step brings its part home.
#pragma once

#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Of the last leg of the path of G, unit, in W; of a step that takes its part off, of the first, along which
/// it comes free. Zero where the part only turns there.
inline Vec3 insertionAxis(const SceneStep& step, const Pose& X_PG) {
  constexpr double kLeast_m = 1e-9;
  const auto& way = step.way_points;
  const Pose& X_from = step.takes_off || way.empty() ? step.X_WP_start : way.back();
  const Pose& X_to = !step.takes_off || way.empty() ? step.X_WP_target : way.front();
  const Vec3 leg_W = X_to * X_PG.p - X_from * X_PG.p;
  return leg_W.norm() < kLeast_m ? Vec3(Vec3::Zero()) : Vec3(leg_W.normalized());
}

}  // namespace vps::scenes
