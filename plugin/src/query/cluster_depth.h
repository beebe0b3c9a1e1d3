// SPDX-License-Identifier: BSD-3-Clause
// How deep the points of a cluster can be: a bound that is continuous in the pose.
#pragma once

#include "query/leaf_walk.h"

namespace vps {

/// What is known of sixteen clusters, from a reading at one point of each [voxels].
struct ClusterBounds {
  float value[kLanes];   ///< the field there
  float radius[kLanes];  ///< no point of the cluster is farther from there
  float depth[kLanes];   ///< no point of the cluster reads less than -depth; at most the band
};

/// Of spheres, see ClusterSamples.
///
/// ReadKernels::bound() is tighter, but steps where a sphere's centre goes from one directory cell to the
/// next, and so would the order in which a budget is spent. Here every term is continuous, with f the true
/// distance, I the field, e its error, r the radius and c the centre, in voxels:
///   I(c) - s r           s the field's steepest slope
///   I(c) - r - 2 e       |I - f| <= e at both ends, and f changes by the way gone
///   gap - r - e          gap the way from c to the box of the surface
///   g - r - e            g a blend of what is known at the centres of the eight cells around c
/// g: if the cells' centres c_j have distances of d_j or more, then f(c) >= d_j - |c - c_j| for each, so also
/// for their mean with trilinear weights w_j; and the mean way is at most sqrt(sum w_j |c - c_j|^2) = 8
/// sqrt(sum over axes of t (1 - t)), which (x + a^2) / 2a bounds without a root. The last two come in as I(c)
/// goes from half of the band, where they cannot tell more, to all of it.
void boundClusters(const Reading& reading, const ShellBlock& spheres, ClusterBounds& out) noexcept;

}  // namespace vps
