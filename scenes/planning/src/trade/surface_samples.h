// SPDX-License-Identifier: BSD-3-Clause
// Sample points on a mesh for surface integrals, independent of any pointshell.
#pragma once

#include <vector>

#include "vps/mesh.h"

namespace vps::scenes {

struct SurfaceSample {
  Vec3 p = Vec3::Zero();
  double area_m2 = 0;  ///< 0 for a vertex, which is used for distances only
};

/// Samples each triangle with about one point per spacing_m^2, at least one, and adds all vertices; in the
/// mesh's frame, only points inside `box`. The points of each triangle follow the R2 sequence, which is
/// evenly distributed. Deterministic. O(points). Source: Roberts, The unreasonable effectiveness of
/// quasirandom sequences, 2018.
std::vector<SurfaceSample> sampleSurface(const Mesh& mesh, double spacing_m, const Box& box);

}  // namespace vps::scenes
