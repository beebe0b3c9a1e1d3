// SPDX-License-Identifier: BSD-3-Clause
// Faults of a mesh that its edges show independently of orientation: duplicate facets and borders.
#pragma once

#include <vector>

#include "mesh/mesh_edges.h"

namespace vps::inline v0 {

/// Keeps one of each set of triangles with the same corners, the first of the majority. Of back-to-back pairs
/// none is kept if other facets end at them or at pairs connected to them: that is a wall between two solids.
/// Otherwise one is kept, of undecided orientation: a surface that was exported for both sides. O(n log n).
void dropDuplicates(Mesh& mesh, const std::vector<HalfEdge>& edges);

/// Counts holes (connected open edges) and T-junctions (corners within an open edge).
void surveyOpenEdges(const Mesh& mesh, const std::vector<HalfEdge>& edges, MeshReport& report);

}  // namespace vps::inline v0
