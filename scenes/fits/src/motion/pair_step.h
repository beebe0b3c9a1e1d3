// SPDX-License-Identifier: BSD-3-Clause
// How far a triangle can move before it penetrates another one.
#pragma once

#include <optional>

#include "motion/motion.h"
#include "surface/part_surface.h"

namespace vps::scenes {

/// A moving part and a held part, with the moving part at the pose X_HM.
struct MovingPair {
  const PartSurface& moving;
  const PartSurface& held;
  Pose X_HM;
  Motion motion;  ///< motion of the moving part, in the frame of the held part
  /// The rest depth: greatest depth to which facets may penetrate each other, since facets in contact overlap
  /// by rounding and facets of flush curved faces cross.
  double rest_m = 0;
};

/// The outward normal n, made perpendicular to a straight motion d: a part above the plane of the result
/// stays above it. Empty where n deviates by more than 30 degrees from a perpendicular of d.
inline std::optional<Vec3> besideMotion(const Vec3& n, const Vec3& d) {
  constexpr double kMostFacing = 0.5;
  const double facing = n.dot(d);
  if (std::abs(facing) > kMostFacing) return std::nullopt;
  return (n - facing * d).normalized();
}

/// A step during which the triangles do not penetrate each other by more than the rest depth. The result is
/// the longest step for which one of a few planes separates the triangles, each part being on the plane's
/// outer side. The step is 0 if the triangles touch and would penetrate, and exact where a face, an edge or a
/// corner of one triangle stops the other triangle. Takes 1 us.
double safeStep(const MovingPair& pair, std::uint32_t moving, std::uint32_t held);

/// The rate at which the triangles approach along the normal of one of them, at their nearest points, per
/// unit of the motion.
double closingSpeed(const MovingPair& pair, std::uint32_t moving, std::uint32_t held);

/// The rate at which triangles in contact approach along the contact normal, per unit of the motion; not
/// negative. The contact normal is that of the touched face, or the common perpendicular of two edges. If the
/// normal is unknown, the result is the lesser of the rates along the normals of both triangles.
double contactRate(const MovingPair& pair, std::uint32_t moving, std::uint32_t held);

/// The depth to which the triangles penetrate each other: the least depth over the planes of the facets and
/// of their nearest features, or 0 if a plane separates the triangles.
double crossingDepth(const MovingPair& pair, std::uint32_t moving, std::uint32_t held);

}  // namespace vps::scenes
