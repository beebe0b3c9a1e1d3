// SPDX-License-Identifier: BSD-3-Clause
// The depth of facets whose edges lie in the other mesh's surface, so that the edges alone show no overlap.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vps/mesh_overlap.h"

namespace vps {

/// The deepest point found in a solid, in its frame.
struct Deepest {
  double depth_m = 0;
  Vec3 p_S = Vec3::Zero();
  bool is_between_edges = false;  ///< found by searchFacets() or searchBelow()
};

/// A point of a facet that lies in both surfaces. Both face the same way there, so both solids are below it.
struct FlushPoint {
  Vec3 p_S, normal_S;
};

/// Probes some facets of `other` at points between their edges, and records depths in `in` that are at least
/// twice the depth of the edges. A recorded depth is a lower bound: it may be a sixteenth too small, or
/// smaller if 80 probes of a facet find less (16 probes as long as none finds a deeper point). Allocates.
std::vector<FlushPoint> searchFacets(const OverlapMesh& in, const OverlapMesh& other, const Pose& X_SO,
                                     std::span<const std::uint32_t> facets, Deepest& deepest);

/// Searches below points that are in both surfaces, half way to the end of the first of the solids. Call it
/// last, because it finds half of a depth that a probe between edges may find.
void searchBelow(const OverlapMesh& in, const OverlapMesh& other, const Pose& X_SO,
                 std::span<const FlushPoint> points, Deepest& deepest);

}  // namespace vps
