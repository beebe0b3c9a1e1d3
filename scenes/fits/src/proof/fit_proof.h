// SPDX-License-Identifier: BSD-3-Clause
// Proof by a fit that a shaft overlaps the bore around it.
#pragma once

#include <vector>

#include "surface/placed_surface.h"

namespace vps::scenes {

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
