// SPDX-License-Identifier: BSD-3-Clause
// Bounds of a field that are computed from its nodes: of the distance at the centres of cells, of the slope,
// and for level sets of other programs.
#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

#include "voxmap/voxmap_layout.h"

namespace vps {

/// The nodes of a brick that are near enough to the surface to be the nearest node of one of its points. Bit
/// z of rows[x / 2 * 4 + y / 2] is set if one of the four nodes (x, y), (x, y + 1), ... is such a node.
struct SurfaceBits {
  std::array<std::uint8_t, 16> rows = {};
  /// Voxels: sqrt(3) / 2, the greatest distance from a point to its nearest node.
  static constexpr double kNear = 0.8661;
};

/// Returns a lower bound of the distance from each cell's centre to the surface [voxels]; it is too small by
/// at most the diagonal of 2 x 2 x 1 nodes. If y is the node nearest to a point q of the surface, then q lies
/// in the unit cube around y, so the surface lies within these cubes. The bound is the exact distance to the
/// cubes, merged 2 x 2. One pass for each axis. Source of the passes: Saito and Toriwaki 1994.
/// @param size   cells of the directory along each axis
/// @param brick  for each cell, index into bits, or -1
std::vector<float> boundCellCenters(const Index3& size, const std::vector<std::int32_t>& brick,
                                    const std::vector<SurfaceBits>& bits);

/// The largest difference of nodes that are one step (X, Y, Z) apart, over a brick [quanta].
template <int X, int Y, int Z>
int mostDifference(const NodeValue* nodes) {
  constexpr int kStep = nodeIndex(X, Y, Z);
  int most = 0;
  for (int x = 0; x < kNodes - X; ++x)
    for (int y = std::max(0, -Y); y < kNodes - std::max(0, Y); ++y)
      for (int z = std::max(0, -Z); z < kNodes - std::max(0, Z); ++z) {
        const NodeValue* node = nodes + nodeIndex(x, y, z);
        most = std::max(most, std::abs(int{node[kStep]} - int{node[0]}));
      }
  return most;
}

/// The largest difference of neighbours along the three axes [quanta].
inline int mostAlongAxes(const NodeValue* nodes) {
  return std::max(
      {mostDifference<1, 0, 0>(nodes), mostDifference<0, 1, 0>(nodes), mostDifference<0, 0, 1>(nodes)});
}

/// Converts a difference of neighbours along an axis to VoxLayout::steepest. Rounding of the values alone can
/// make a difference of one quantum, which is subtracted.
inline float steepnessOf(int difference, double voxel_m, double quantum_m) {
  return static_cast<float>((difference - 1) * quantum_m / voxel_m * (1 + 1e-6));
}

/// Sets the bounds that queries rely on from the nodes alone: steepest, node_error, centers_m and parts.
/// Returns the box of the surface, empty if no sign changes. Deterministic. O(nodes).
///
/// Culling needs a 1-Lipschitz function near the nodes; true distances are such a function, but are not
/// required. Let N be the nodes below the band, in voxels, and take the cones f(p) = min over j in N of
/// (node_j + e + |p - j|). f is 1-Lipschitz, and |node - f| <= e at every node (at saturated nodes: |node -
/// min(f, band)| <= e) if node_i - node_j <= |i - j| + 2e for all i, j. This condition holds with
///   2e = 2 band (1 - 1 / (c s)),
/// if nodes of one grid cell differ by at most s times their distance: a path over grid cells from i to j is
/// at most c = 1.1281 times as long as |i - j|, so the difference is at most min(2 band, c s |i - j|). The
/// deepest points are bounded in the same way from the other side. f is also at least the distance to a box
/// if e is raised by the largest amount by which a node is below that distance. [Extension by cones: McShane
/// 1934.]
VPS_API Box proveField(VoxLayout& layout, double voxel_m, double quantum_m);

}  // namespace vps
