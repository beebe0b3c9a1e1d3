// SPDX-License-Identifier: BSD-3-Clause
// Bounds for level sets of other programs, proven from their nodes, so that culling stays exact.
#pragma once

#include "voxmap/voxmap_layout.h"

namespace vps {

/// Sets the bounds that queries rely on from the nodes alone: steepest, node_error, centers_m and parts.
/// Returns the box of the surface, empty if no sign changes. Deterministic. O(nodes).
///
/// Nodes that are not true distances are near a 1-Lipschitz function, which serves as well. With N the nodes
/// below the band, in voxels, take the cones f(p) = min over j in N of (node_j + e + |p - j|). f is
/// 1-Lipschitz, and |node - f| <= e at every node (at saturated nodes: of min(f, band)) if node_i - node_j <=
/// |i - j| + 2e for all i, j. That holds with
///   2e = 2 band (1 - 1 / (c s)),
/// where nodes of one grid cell differ by at most s times their distance: a path over grid cells from i to j
/// is at most c = 1.1281 times as long as |i - j|, so the difference is at most min(2 band, c s |i - j|). The
/// deepest points are bounded likewise from the other side. f is also at least the distance to a box if e is
/// raised by what the nodes are below that distance. [Extension by cones: McShane 1934.]
VPS_API Box proveField(VoxLayout& layout, double voxel_m, double quantum_m);

}  // namespace vps
