// SPDX-License-Identifier: BSD-3-Clause
// A lower bound of the distance from every directory cell's centre to a surface, from the nodes beside it.
#pragma once

#include "voxmap/voxmap_layout.h"

namespace vps {

/// Which nodes of a brick lie so near the surface that they may be nearest to a point of it: bit z of
/// rows[x / 2 * 4 + y / 2], where one of the four nodes (x, y), (x, y + 1), ... is.
struct SurfaceBits {
  std::array<std::uint8_t, 16> rows = {};
  static constexpr double kNear = 0.8661;  ///< voxels: sqrt(3) / 2, the farthest that a node can be
};

/// A value that the distance from each cell's centre to the surface is not below [voxels]; it falls short by
/// the diagonal of 2 x 2 x 1 nodes at most. The surface's nearest node y to a point q of it has q in its unit
/// cube, so the surface lies within those cubes; the exact distance to them, 2 x 2 together, is the bound.
/// One pass for each axis. Source of the passes: Saito and Toriwaki 1994.
/// @param size   of the directory
/// @param brick  for each cell, index into bits, or -1
std::vector<float> boundCellCenters(const Index3& size, const std::vector<std::int32_t>& brick,
                                    const std::vector<SurfaceBits>& bits);

}  // namespace vps
