// SPDX-License-Identifier: BSD-3-Clause
// Closes narrow cracks. Along a crack every facet ends in an edge of its own, and contact would take each for
// a sharp edge of the part.
#pragma once

#include "mesh/mesh_edges.h"

namespace vps {

struct ClosedCracks {
  Mesh mesh;
  std::size_t corners = 0;  ///< vertices that were moved onto another one
  double widest_m = 0;      ///< greatest way that one was moved
};

/// Widest crack that is closed: this share of the mesh's size, and no more than kClosedCrack_m. assumed: a
/// surface that moves by less is not told from another by any verdict, which counts 2 um (DESIGN.md).
inline constexpr double kClosedCrackShare = 1e-4, kClosedCrack_m = 2e-6;

/// Moves vertices of open edges that are that near to each other, and nearer than a quarter of the edges
/// beside them, to the one of them that most facets have. Facets without a third corner are left out.
/// Without such vertices, as given. O(n log n).
ClosedCracks closeCracks(const Mesh& mesh, const std::vector<HalfEdge>& edges);

}  // namespace vps
