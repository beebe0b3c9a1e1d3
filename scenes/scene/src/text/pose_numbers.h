// SPDX-License-Identifier: BSD-3-Clause
// A pose from seven numbers, as tables and ROS 2 have it.
#pragma once

#include <cmath>
#include <optional>
#include <span>

#include "vps/pose.h"

namespace vps::scenes {

/// @param n  x, y, z and a quaternion x, y, z, w
/// @return  none where the numbers are not finite or the quaternion is no rotation; its length may miss one
/// by
///          1e-3, as those with three digits do
inline std::optional<Pose> poseOf(std::span<const double, 7> n) {
  constexpr double kUnit = 1e-3;
  const Quat q(n[6], n[3], n[4], n[5]);
  const Vec3 p(n[0], n[1], n[2]);
  if (!p.allFinite() || !(std::abs(q.norm() - 1) <= kUnit)) return {};
  return Pose(q.normalized(), p);
}

}  // namespace vps::scenes
