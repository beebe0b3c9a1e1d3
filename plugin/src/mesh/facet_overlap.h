// SPDX-License-Identifier: BSD-3-Clause
// The depth of facets whose edges lie in the other mesh's surface, where the edges alone show no overlap.
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
  bool is_between_edges = false;  ///< found by the functions below
};

/// A point of a facet that is in both surfaces, which face the same way there: both solids are below it.
struct FlushPoint {
  Vec3 p_S, normal_S;
};

/// Probes some facets of `other` at points between their edges, and records what is at least twice as deep in
/// `in` as its edges. The depth found is a lower bound, by a sixteenth or where it exceeds what 80 probes for
/// a facet find; 16 for each as long as none is deeper. Allocates.
std::vector<FlushPoint> searchFacets(const OverlapMesh& in, const OverlapMesh& other, const Pose& X_SO,
                                     std::span<const std::uint32_t> facets, Deepest& deepest);

/// Looks below points that are in both surfaces, half way to where the first of the solids ends. This comes
/// last, since it finds half of a depth that a probe between edges may show.
void searchBelow(const OverlapMesh& in, const OverlapMesh& other, const Pose& X_SO,
                 std::span<const FlushPoint> points, Deepest& deepest);

}  // namespace vps
