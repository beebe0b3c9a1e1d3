// SPDX-License-Identifier: BSD-3-Clause
// The errors of a voxmap's distance and normal against the mesh it was built from.
#pragma once

#include <string>
#include <vector>

#include "vps/mesh.h"

namespace vps::bench {

/// Mean, 99th percentile and greatest value.
struct Spread {
  double mean = 0, p99 = 0, most = 0;
};

struct AccuracyPoint {
  std::string shape;
  bool is_sharp = false;
  double voxel_m = 0;
  Spread distance_m;                     ///< against the exact distance to the mesh
  Spread continuous_rad, trilinear_rad;  ///< of the normal, for both ways to read it
};

/// All shapes at all voxel sizes; samples lie within one voxel of the surface. Takes a minute or so.
std::vector<AccuracyPoint> accuracyStudy(int samples);

}  // namespace vps::bench
