// SPDX-License-Identifier: BSD-3-Clause
// The least distance of two surfaces.
#pragma once

#include "surface/part_surface.h"

namespace vps::scenes {

struct SurfaceGap {
  double distance_m = 0;  ///< at least most_m if nothing is nearer; 0 where the surfaces touch or cross
  Vec3 p_A = Vec3::Zero(), p_B = Vec3::Zero();  ///< the nearest points, in the frame of A
};

/// Exact to rounding: the least distance over all pairs of triangles. @param X_AB pose of B in A.
/// O(log n) typical, more where large areas are equally far.
SurfaceGap surfaceGap(const PartSurface& a, const PartSurface& b, const Pose& X_AB, double most_m);

}  // namespace vps::scenes
