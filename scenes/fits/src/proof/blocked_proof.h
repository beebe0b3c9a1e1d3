// SPDX-License-Identifier: BSD-3-Clause
// Proofs that parts overlap wherever they are within their tolerances.
#pragma once

#include <span>
#include <vector>

#include "pair/touches.h"
#include "proof/places.h"
#include "surface/placed_surface.h"

namespace vps::scenes {

/// A touch with its weight in the solution of leastMotion().
struct PressedTouch {
  Touch touch;
  double allowed_m = 0;  ///< depth to which the point may be below the plane, since facets in contact cross
  double error_m = 0;    ///< error of the pair's meshes plus kContactDepth_m
  double weight = 0;     ///< amount by which the gap stays negative in the least-squares solution
};

/// For each touch, an upper bound of its gap without the part that is linear in the motion, for all positions
/// of the bodies within their tolerances.
/// @param moved_m by body: greatest displacement of a corner from its drawn place
std::vector<double> greatestGaps_m(const std::vector<PlacedSurface>& parts, const std::vector<Pose>& X_WP,
                                   std::span<const PressedTouch> touches,
                                   const std::vector<MovableBody>& bodies,
                                   const std::vector<double>& moved_m);

/// A proven overlap: for all positions of the bodies within their tolerances, some pair of the touches' parts
/// overlaps by at least the result beyond error_m. If the result is 0 or less, nothing is proven.
///
/// A point p of one part overlaps a ball of radius r about c inside another part unless h = |p - c| - r >= 0.
/// A mean of such h with positive weights is negative only if at least one h is negative. Let n be the
/// direction from c to p, and w the displacement of p relative to c. The displacement increases h by at most
/// n . w + |w|^2 / (2 (|p - c| - |w|)). The displacement w is linear in the motion of the bodies, up to
/// |turn|^2 arm / 2 for a rotation. With the weights of the least-squares solution, the forces along n are in
/// balance on each body, so the linear part of the mean vanishes up to rounding. The remainder of the linear
/// part is bounded over all motions within the tolerances. Source: Farkas' lemma, with remainders.
/// @param moved_m by body: greatest displacement of a corner from its drawn place
double provenOverlap_m(const std::vector<PlacedSurface>& parts, const std::vector<Pose>& X_WP,
                       std::span<const PressedTouch> touches, const std::vector<MovableBody>& bodies,
                       const std::vector<double>& moved_m);

/// How far a part may be from its place without the operator seeing the error; 0 for a fixed part.
double mayMove_m(const PlacedSurface& part);

/// Whether it is proven by a fit that a shaft overlaps its bore for all positions of the two parts at which
/// no point is farther than kSightTolerance_m from its drawn place (fixed parts do not move). The corners of
/// facets lie on the true faces, so the proof holds within the error of the fit, however coarse the facets
/// are.
///
/// The proof uses a slice across the bore in which every third of a turn has a point of the bore's face. If
/// the slice moves sideways by t < radius relative to the shaft, one of its points lies within a sixth of a
/// turn of the direction back to the shaft's axis. This point is no farther from the shaft's axis than the
/// bore's radius. The point is therefore inside the shaft, if the shaft is round all around and has no hole
/// near its face over the length by which the slice may move along the axis. A tilt of the slice only brings
/// its points nearer to the axis. A shaft that is shorter than the slice may move is left to coverPoses().
bool isProvenByFit(const std::vector<PlacedSurface>& parts, const CheckedFit& fit);

}  // namespace vps::scenes
