// SPDX-License-Identifier: BSD-3-Clause
// The searches of deepestOverlap(): for the deepest point of a piece of an edge, and for the depth of facets
// whose edges lie in the other mesh's surface, so that the edges alone show no overlap.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vps/mesh_overlap.h"
#include "vps/solid.h"

namespace vps {

/// The deepest point found in a solid, in its frame.
struct Deepest {
  double depth_m = 0;
  Vec3 p_S = Vec3::Zero();
  bool is_between_edges = false;  ///< found by searchFacets() or searchBelow()
};

/// A point of a facet that lies in both surfaces. Both surfaces face the same way there, so both solids are
/// below the facet.
struct FlushPoint {
  Vec3 p_S, normal_S;
};

/// Probes some facets of `other` at points between their edges, and records depths in `in` that are at least
/// twice the depth of the edges. A recorded depth is a lower bound: it may be a sixteenth too small, or
/// smaller if 80 probes of a facet find less (16 probes as long as none finds a deeper point). Allocates.
std::vector<FlushPoint> searchFacets(const OverlapMesh& in, const OverlapMesh& other, const Pose& X_SO,
                                     std::span<const std::uint32_t> facets, Deepest& deepest);

/// Searches below points that are in both surfaces, half way to the end of the first of the solids. Call
/// searchBelow() last, because it finds half of a depth that a probe between edges may find.
void searchBelow(const OverlapMesh& in, const OverlapMesh& other, const Pose& X_SO,
                 std::span<const FlushPoint> points, Deepest& deepest);

/// Searches segment ab for points deeper than depth_m by more than certain_m; sets depth_m and p_S to the
/// deepest point found. The segment must lie wholly inside or wholly outside, except where it passes a crack
/// of the mesh. The distance changes its sign at a crack, so depths there are accurate to the crack's width.
/// Returns false if the segment is outside and farther than certain_m from the surface.
bool searchUncrossed(const Solid& solid, const Vec3& a, const Vec3& b, double certain_m, double& depth_m,
                     Vec3& p_S);

/// The distance to one triangle, which is at least the distance to the surface.
double distanceToTriangle(const Solid& solid, std::uint32_t triangle, const Vec3& p);

}  // namespace vps
