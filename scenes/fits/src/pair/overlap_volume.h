// SPDX-License-Identifier: BSD-3-Clause
// The volume that two solids share.
#pragma once

#include "surface/part_surface.h"

namespace vps::scenes {

struct OverlapVolume {
  double volume_m3 = 0;
  double area_m2 = 0;  ///< of its surface
  /// A bound for the meshes: the shift, and what the vector areas of the found surface lack of zero. A hole
  /// of an open mesh adds its area times a sixth of the overlap's diagonal.
  double error_m3 = 0;
  double faces_error_m3 = 0;  ///< by the distance of the facets from the curved faces that they stand for
};

/// By the divergence theorem over the parts of each surface inside the other solid, whose areas are exact:
/// B is moved by kVolumeShift_m first, so that no two faces coincide. O(facets near the other part x log
/// facets).
inline constexpr double kVolumeShift_m = 1e-9;
OverlapVolume overlapVolume(const PartSurface& a, const PartSurface& b, const Pose& X_AB);

}  // namespace vps::scenes
