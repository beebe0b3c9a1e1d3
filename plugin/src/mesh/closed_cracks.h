// SPDX-License-Identifier: BSD-3-Clause
// Closes narrow cracks. Along a crack every facet has an edge of its own, which contact would take for a
// sharp edge of the part.
#pragma once

#include "mesh/mesh_edges.h"

namespace vps {

struct ClosedCracks {
  Mesh mesh;
  std::size_t corners = 0;  ///< vertices that were moved onto another one
  double widest_m = 0;      ///< greatest distance by which a vertex was moved
};

/// Widest crack that is closed: this share of the mesh's size, and at most kClosedCrack_m. Assumed: a motion
/// of the surface by less changes no verdict, because verdicts tolerate 2 um (DESIGN.md).
inline constexpr double kClosedCrackShare = 1e-4, kClosedCrack_m = 2e-6;

/// Joins vertices of open edges that are this near to each other, and nearer than a quarter of the edges
/// beside them: all move to the one with the most facets. Facets that lose a corner are left out. Returns the
/// mesh unchanged if there are no such vertices. O(n log n).
ClosedCracks closeCracks(const Mesh& mesh, const std::vector<HalfEdge>& edges);

}  // namespace vps
