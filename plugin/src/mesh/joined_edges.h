// SPDX-License-Identifier: BSD-3-Clause
// Tells which facets are neighbours although a crack or a T-junction separates them. Orientation and
// duplicates are decided by this. Vertices are not moved; closed_cracks.h moves the vertices of narrow
// cracks.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/mesh_edges.h"

namespace vps {

struct JoinedFacets {
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< vertices that are near each other have one number
  /// Half-edges of these triangles, grouped by edge. Open edges are cut at the vertices that lie on them.
  std::vector<HalfEdge> edges;
  double open_m = 0;  ///< length of edges that still have only one facet
};

/// Widest gaps, as shares of the mesh's size. Assumed: cracks of 30 um in a part of 20 mm, and copies of a
/// facet 8 um apart. Facets farther apart than these may be the two sides of a plate.
inline constexpr double kWidestCrack = 1.6384e-3;
inline constexpr double kWidestBetweenCopies = 4.096e-4;

/// Joins across the narrowest gaps that close the mesh. The tolerance grows by factors of four from a
/// ten-millionth of the mesh's size, where floats are rounded, until no open edge is left or `widest` is
/// reached; of the tolerances that leave the least open length the narrowest is taken. A gap is never wider
/// than a quarter of the edges beside it. A mesh without open edges is returned unchanged. O(n log n).
JoinedFacets joinFacets(const Mesh& mesh, const std::vector<HalfEdge>& edges, double widest);

/// Groups of patches that are separated only by cracks.
struct LinkedPatches {
  std::vector<std::uint32_t> group_of;  ///< by patch: its group, counted from 0 in the order of first patches
  std::vector<std::uint8_t> is_opposed;  ///< by patch: must be turned to agree with its group's first patch
};

/// Joins patches at edges of two facets, patches with the longest common edges first: if the edges of a group
/// contradict each other, the longest decide. O(n log n).
/// @param patch_of  by triangle: its patch, counted from 0
/// @param is_turned  by triangle: it must be turned, relative to `edges`, to agree with its patch
LinkedPatches linkPatches(const Mesh& mesh, const std::vector<HalfEdge>& edges,
                          const std::vector<std::uint32_t>& patch_of,
                          const std::vector<std::uint8_t>& is_turned);

}  // namespace vps
