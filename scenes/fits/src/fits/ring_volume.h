// SPDX-License-Identifier: BSD-3-Clause
// The volume that a round shaft shares with a bore that is smaller.
#pragma once

#include "surface/placed_surface.h"

namespace vps::scenes {

struct RingVolume {
  double volume_m3 = 0, error_m3 = 0;
};

/// Of the true cylinders of a fit with interference: pi / 4 (shaft^2 - bore^2) length, times the share of the
/// ring where both parts have material, which is told at 64 angles and 16 places along the axis. The error is
/// that of the diameters, and the cells between such a place with material and one without. A keyway or
/// groove narrower than a cell is not seen.
/// @param aside_m how far off the cylinders the material is looked for: more than the meshes are off them
RingVolume ringVolume(const CheckedFit& fit, const PlacedSurface& shaft, const PlacedSurface& bore,
                      double aside_m);

}  // namespace vps::scenes
