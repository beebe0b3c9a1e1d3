// SPDX-License-Identifier: BSD-3-Clause
// Lower bounds of the distance from the centre of every directory cell to a surface. They are computed from
// the nodes near the surface.
#pragma once

#include "voxmap/voxmap_layout.h"

namespace vps {

/// The nodes of a brick that are near enough to the surface to be the nearest node of one of its points. Bit
/// z of rows[x / 2 * 4 + y / 2] is set if one of the four nodes (x, y), (x, y + 1), ... is such a node.
struct SurfaceBits {
  std::array<std::uint8_t, 16> rows = {};
  static constexpr double kNear = 0.8661;  ///< voxels: sqrt(3) / 2, the greatest distance of such a node
};

/// Returns a lower bound of the distance from each cell's centre to the surface [voxels]; it is too small by
/// at most the diagonal of 2 x 2 x 1 nodes. If y is the node nearest to a point q of the surface, then q lies
/// in the unit cube around y, so the surface lies within these cubes. The bound is the exact distance to the
/// cubes, merged 2 x 2. One pass for each axis. Source of the passes: Saito and Toriwaki 1994.
/// @param size   cells of the directory along each axis
/// @param brick  for each cell, index into bits, or -1
std::vector<float> boundCellCenters(const Index3& size, const std::vector<std::int32_t>& brick,
                                    const std::vector<SurfaceBits>& bits);

}  // namespace vps
