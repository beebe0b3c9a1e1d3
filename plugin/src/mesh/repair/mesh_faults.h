// SPDX-License-Identifier: BSD-3-Clause
// Faults of a mesh and their repair: cracks and T-junctions, duplicate facets, facets without area, holes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/mesh_edges.h"
#include "vps/mesh.h"

namespace vps {

/// Facets with the neighbours that they have if cracks and T-junctions count as closed. Orientation and
/// duplicates are decided by these neighbours. No vertex is moved; see closeCracks().
struct JoinedFacets {
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< vertices that are near each other have one number
  /// Half-edges of these triangles, grouped by edge. Open edges are cut at the vertices that lie on them.
  std::vector<HalfEdge> edges;
  double open_m = 0;  ///< length of edges that still have only one facet
};

/// Widest gaps, as shares of the mesh's size. Assumed: cracks of 30 um in a part of 20 mm, and copies of a
/// facet 8 um apart. Facets farther apart than these gaps may be the two sides of a plate.
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

struct ClosedCracks {
  Mesh mesh;
  std::size_t corners = 0;  ///< vertices that were moved onto another one
  double widest_m = 0;      ///< greatest distance by which a vertex was moved
};

/// Widest crack that is closed: this share of the mesh's size, and at most kClosedCrack_m. Assumed: a motion
/// of the surface by less than 2 um changes no verdict, because verdicts tolerate 2 um (DESIGN.md).
inline constexpr double kClosedCrackShare = 1e-4, kClosedCrack_m = 2e-6;

/// Joins vertices of open edges whose distance is at most that of the widest closed crack, and less than a
/// quarter of the edges beside them: all move to the vertex with the most facets. Facets that lose a corner
/// are left out. Returns the mesh unchanged if there are no such vertices. O(n log n).
ClosedCracks closeCracks(const Mesh& mesh, const std::vector<HalfEdge>& edges);

/// Flags all but one of each set of triangles with the same corners; the first triangle of the majority
/// orientation stays. Of back-to-back pairs none stays if an even number of other facets ends at each edge of
/// the pair and of pairs connected to it, since these facets close without the pair: it is a wall between two
/// solids. Otherwise one facet of the pair stays, of undecided orientation: a surface that was exported for
/// both sides, or given twice and turned once. O(n log n).
/// @param edges  half-edges of the same triangles
std::vector<std::uint8_t> findDuplicates(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                         const std::vector<HalfEdge>& edges);

/// Counts holes (connected open edges) and T-junctions (corners within an open edge).
void surveyOpenEdges(const Mesh& mesh, const std::vector<HalfEdge>& edges, MeshReport& report);

/// The mesh without facets of no area. The facet across the longest side of each such facet is split at its
/// middle corner, so that a closed mesh stays closed. Vertices stay. Returns no value if some facet could not
/// be left out. O(n log n).
std::optional<Mesh> withoutFlatFacets(Mesh mesh);

}  // namespace vps
