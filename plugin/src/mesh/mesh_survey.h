// SPDX-License-Identifier: BSD-3-Clause
// What the edges of a mesh tell of its faults, whichever way it faces: facets that are there twice, and
// borders.
#pragma once

#include <vector>

#include "mesh/mesh_edges.h"

namespace vps {

/// Keeps one of each set of triangles with the same corners, the majority's first. Of pairs back to back none
/// where other facets end at them, or at pairs they are joined to: a wall between two solids. Elsewhere one,
/// which way it faces to be judged: a surface that was exported for both sides. O(n log n).
void dropDuplicates(Mesh& mesh, const std::vector<HalfEdge>& edges);

/// Counts holes (connected open edges) and T-junctions (corners within an open edge).
void surveyOpenEdges(const Mesh& mesh, const std::vector<HalfEdge>& edges, MeshReport& report);

}  // namespace vps
