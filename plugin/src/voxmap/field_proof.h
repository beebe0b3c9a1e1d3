// SPDX-License-Identifier: BSD-3-Clause
// Computes bounds for level sets of other programs from their nodes, so that culling stays exact.
#pragma once

#include "voxmap/voxmap_layout.h"

namespace vps {

/// Sets the bounds that queries rely on from the nodes alone: steepest, node_error, centers_m and parts.
/// Returns the box of the surface, empty if no sign changes. Deterministic. O(nodes).
///
/// Culling needs a 1-Lipschitz function near the nodes; true distances are one, but are not required. Let N
/// be the nodes below the band, in voxels, and take the cones f(p) = min over j in N of (node_j + e + |p -
/// j|). f is 1-Lipschitz, and |node - f| <= e at every node (at saturated nodes: |node - min(f, band)| <= e)
/// if node_i - node_j <= |i - j| + 2e for all i, j. This condition holds with
///   2e = 2 band (1 - 1 / (c s)),
/// if nodes of one grid cell differ by at most s times their distance: a path over grid cells from i to j is
/// at most c = 1.1281 times as long as |i - j|, so the difference is at most min(2 band, c s |i - j|). The
/// deepest points are bounded in the same way from the other side. f is also at least the distance to a box
/// if e is raised by the largest amount by which a node is below that distance. [Extension by cones: McShane
/// 1934.]
VPS_API Box proveField(VoxLayout& layout, double voxel_m, double quantum_m);

}  // namespace vps
