// SPDX-License-Identifier: BSD-3-Clause
// Points on a mesh for sums over its surface, independent of any pointshell.
#pragma once

#include <vector>

#include "vps/mesh.h"

namespace vps::scenes {

struct SurfaceSample {
  Vec3 p = Vec3::Zero();
  double area_m2 = 0;  ///< 0 for a vertex, which serves distances only
};

/// About one point for each spacing_m^2 of every triangle, at least one, and the vertices; in the mesh's
/// frame, and only those inside `box`. Each triangle's points follow the R2 sequence, so that they are spread
/// evenly. Deterministic. O(points). Source: Roberts, The unreasonable effectiveness of quasirandom
/// sequences, 2018.
std::vector<SurfaceSample> sampleSurface(const Mesh& mesh, double spacing_m, const Box& box);

}  // namespace vps::scenes
