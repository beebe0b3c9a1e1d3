// SPDX-License-Identifier: BSD-3-Clause
// Faults of a mesh that do not depend on orientation: duplicate facets, holes and T-junctions.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/mesh_edges.h"

namespace vps {

/// Flags all but one of each set of triangles with the same corners; the first triangle of the majority
/// orientation stays. Of back-to-back pairs none stays if an even number of other facets ends at each edge of
/// the pair and of pairs connected to it, since these facets close without it: a wall between two solids.
/// Otherwise one stays, of undecided orientation: a surface that was exported for both sides, or given twice
/// and turned once. O(n log n).
/// @param edges  half-edges of the same triangles
std::vector<std::uint8_t> findDuplicates(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                         const std::vector<HalfEdge>& edges);

/// Counts holes (connected open edges) and T-junctions (corners within an open edge).
void surveyOpenEdges(const Mesh& mesh, const std::vector<HalfEdge>& edges, MeshReport& report);

}  // namespace vps
