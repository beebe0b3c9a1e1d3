// SPDX-License-Identifier: BSD-3-Clause
// How far a triangle may move before it enters another.
#pragma once

#include <optional>

#include "motion/motion.h"
#include "surface/part_surface.h"

namespace vps::scenes {

/// A moving part and one that is held, while the moving part stands at X_HM.
struct MovingPair {
  const PartSurface& moving;
  const PartSurface& held;
  Pose X_HM;
  Motion motion;  ///< of the moving part, in the frame of the held one
  /// How deep facets may be in each other: they rest on each other with rounding, and facets of flush curved
  /// faces cross.
  double rest_m = 0;
};

/// An outward normal across a straight motion d: a part above its plane stays so. None for a surface that
/// faces the motion at more than 30 degrees.
inline std::optional<Vec3> besideMotion(const Vec3& n, const Vec3& d) {
  constexpr double kMostFacing = 0.5;
  const double facing = n.dot(d);
  if (std::abs(facing) > kMostFacing) return std::nullopt;
  return (n - facing * d).normalized();
}

/// A way for which the triangles certainly do not enter each other by more than the rest depth: the longest
/// for which one plane of a few parts them, with each part on its outer side. It is 0 where they touch and
/// would enter, and exact where a face, an edge or a corner stops the other. 1 us.
double safeStep(const MovingPair& pair, std::uint32_t moving, std::uint32_t held);

/// How fast the triangles come nearer along the normal of one of them, at their nearest points, per unit of
/// the motion.
double closingSpeed(const MovingPair& pair, std::uint32_t moving, std::uint32_t held);

/// How fast they come nearer along the normal of the contact, per unit of the motion, where they touch: along
/// that of the face that is touched, or across two edges. Where that cannot be told the lesser of those of
/// both triangles. Not negative.
double contactRate(const MovingPair& pair, std::uint32_t moving, std::uint32_t held);

/// How deep the triangles are in each other now: the least over the planes of the facets and their nearest
/// features; 0 where a plane parts them.
double crossingDepth(const MovingPair& pair, std::uint32_t moving, std::uint32_t held);

}  // namespace vps::scenes
