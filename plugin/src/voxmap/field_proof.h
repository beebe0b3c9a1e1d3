// SPDX-License-Identifier: BSD-3-Clause
// What can be proven of nodes that came from elsewhere, so that culling by them stays exact.
#pragma once

#include "voxmap/voxmap_layout.h"

namespace vps {

/// Sets what queries rely on, from nothing but the nodes: steepest, node_error, centers_m and parts. Returns
/// the box of the surface, empty if no sign changes. Deterministic. O(nodes).
///
/// Nodes that are no true distances have functions that are as good. With N the nodes below the band, in
/// voxels, take the cones f(p) = min over j in N of (node_j + e + |p - j|). f changes by no more than the way
/// gone, and |node - f| <= e at every node (saturated ones: min(f, band)) if node_i - node_j <= |i - j| + 2e
/// for all i, j. That holds with
///   2e = 2 band (1 - 1 / (c s)),
/// where nodes of one grid cell differ by at most s times their distance: a way over grid cells from i to j
/// is at most c = 1.1281 times as long as |i - j|, so the difference is at most min(2 band, c s |i - j|). The
/// deepest points are bounded likewise from the other side. f also is not below the way to a box, if e is
/// raised to what nodes lack there. [Extension by cones: McShane 1934.]
Box proveField(VoxLayout& layout, double voxel_m, double quantum_m);

}  // namespace vps
