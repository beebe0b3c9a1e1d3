// SPDX-License-Identifier: BSD-3-Clause
// Which facets lie side by side although a crack or a T-junction parts them. Orientation and duplicates are
// decided by this. Vertices stay where they are; closed_cracks.h moves those of narrow cracks.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/mesh_edges.h"

namespace vps {

struct JoinedFacets {
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< near vertices have one number
  /// Of these triangles; edges that had one facet are cut at the vertices that lie on them. Grouped by edge.
  std::vector<HalfEdge> edges;
  double open_m = 0;  ///< length of edges that have one facet still
};

/// Widest gaps, as shares of the mesh's size. Assumed: cracks of 30 um in a part of 20 mm, and copies of a
/// facet 8 um apart. Facets farther apart than these may be the two sides of a plate.
inline constexpr double kWidestCrack = 1.6384e-3;
inline constexpr double kWidestBetweenCopies = 4.096e-4;

/// Joins across the narrowest gaps that close the mesh: the tolerance grows from a ten-millionth of the
/// mesh's size, where floats are rounded, by factors of four until no edge has one facet only or `widest` is
/// reached; of the tolerances that leave least length open the narrowest is taken. A gap is never wider than
/// a quarter of the edges beside it. Without open edges, as given. O(n log n).
JoinedFacets joinFacets(const Mesh& mesh, const std::vector<HalfEdge>& edges, double widest);

/// Patches that cracks part, taken together.
struct LinkedPatches {
  std::vector<std::uint32_t> group_of;   ///< by patch; counted from 0 by first patches
  std::vector<std::uint8_t> is_opposed;  ///< by patch: to be turned to agree with its group's first
};

/// Joins patches at edges of two facets, those with the longest edge in common first: where the edges of a
/// group contradict each other, the longest decide. O(n log n).
/// @param patch_of  by triangle, counted from 0
/// @param is_turned  by triangle: against `edges`, so that its patch agrees
LinkedPatches linkPatches(const Mesh& mesh, const std::vector<HalfEdge>& edges,
                          const std::vector<std::uint32_t>& patch_of,
                          const std::vector<std::uint8_t>& is_turned);

}  // namespace vps
