// SPDX-License-Identifier: BSD-3-Clause
// Proofs that parts overlap wherever they are within their tolerances.
#pragma once

#include <span>
#include <vector>

#include "pair/touches.h"
#include "proof/places.h"
#include "surface/placed_surface.h"

namespace vps::scenes {

/// A touch that presses, as leastMotion() found it.
struct PressedTouch {
  Touch touch;
  double allowed_m = 0;  ///< that its point may be below the plane: facets of parts in contact cross
  double error_m = 0;    ///< of the meshes of its pair, and the overlap that counts as contact
  double weight = 0;     ///< how far its gap stays negative where the sum of squares is least
};

/// By touch: an upper bound of its gap, less what is linear in the motion, wherever the bodies are within
/// their tolerances.
/// @param moved_m  by body: how far its farthest corner is from where it is drawn
std::vector<double> greatestGaps_m(const std::vector<PlacedSurface>& parts, const std::vector<Pose>& X_WP,
                                   std::span<const PressedTouch> touches,
                                   const std::vector<MovableBody>& bodies,
                                   const std::vector<double>& moved_m);

/// An overlap beyond error_m that some pair of the touches' parts has wherever the bodies are within their
/// tolerances; 0 or less: there may be none.
///
/// A point p of one part and a ball of radius r about c in another overlap unless h = |p - c| - r >= 0. Any
/// mean of such h with positive weights is negative only if one h is. Along n, from c to p, a displacement w
/// of p against c changes h by no more than n . w + |w|^2 / (2 (|p - c| - |w|)), and w is linear in the
/// motion of the bodies but for a turn's |turn|^2 arm / 2. With the weights of a least sum of squares, forces
/// along n are in balance on each body, so that the linear part of the mean vanishes, up to rounding: what
/// is left of it is bounded over all motions within the tolerances. Source: Farkas' lemma, with remainders.
/// @param moved_m  by body: how far its farthest corner is from where it is drawn
double provenOverlap_m(const std::vector<PlacedSurface>& parts, const std::vector<Pose>& X_WP,
                       std::span<const PressedTouch> touches, const std::vector<MovableBody>& bodies,
                       const std::vector<double>& moved_m);

/// How far a part may be from where it belongs without that being seen.
double mayMove_m(const PlacedSurface& part);

/// Whether a shaft overlaps its bore wherever the two parts are, as long as none of their points is farther
/// from where it is drawn than sight tells (kSightTolerance_m; fixed parts stay). The corners of facets lie
/// on the true faces, so that this holds to the error of the fit, however coarse the facets are.
///
/// Taken is a slice across the bore in which no third of a turn is without a point of its face. By whatever
/// way t < radius the slice moves against the shaft, a point of it lies within a sixth of a turn of the
/// direction back to the shaft's axis, and is then no farther from that axis than the bore's radius: inside
/// the shaft, where this one is round all around and without a hole near its face, as far along its axis as
/// the slice may move. A turn of the slice only brings its points nearer to the axis. It does not hold the
/// other way around: a disc that is larger than a bore can stand in it at a slant.
bool isProvenByFit(const std::vector<PlacedSurface>& parts, const CheckedFit& fit);

}  // namespace vps::scenes
