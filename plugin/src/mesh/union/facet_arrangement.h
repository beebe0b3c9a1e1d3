// SPDX-License-Identifier: BSD-3-Clause
// Cuts facets of a mesh along their intersections, so that they meet only at common vertices and edges, and
// triangulates the cut facets by exact predicates.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vps/mesh.h"
#include "vps/pose.h"

namespace vps {

/// A mesh whose facets have been cut.
struct Arrangement {
  Mesh mesh;                          ///< the given vertices keep their numbers and places
  std::vector<std::uint32_t> source;  ///< for each triangle the facet from which it was cut
};

/// True if two facets share a point, or come nearer to each other than `touch_m` and are not clearly apart.
bool mayTouch(const Mesh& mesh, std::uint32_t f, std::uint32_t g, double touch_m);

/// Cuts the facets of each of the given pairs along their intersection. Features nearer to each other than
/// touch_m become one: vertices are merged, vertices near an edge or a facet become part of it, edges that
/// nearly meet get a common point. Facets that lie on each other are both cut along each other's edges.
/// Method as in: OpenCASCADE, Boolean operations, General Fuse (vertices first, then edges, then faces).
/// Returns nothing if some facet cannot be triangulated or if work_left falls below 0. Each test for nearness
/// within facets subtracts 1 from work_left and takes about a microsecond. O(pairs) and, in each facet, O(n
/// log n) for points and segments with few others near.
std::optional<Arrangement> arrange(const Mesh& mesh, std::span<const std::array<std::uint32_t, 2>> pairs,
                                   double touch_m, std::int64_t& work_left);

/// A facet with the points and segments that cut it. Points are numbered as in a common list.
struct CutFacet {
  std::array<std::vector<std::uint32_t>, 3> sides;  ///< of each side its first corner, then the points on it
  std::vector<std::uint32_t> inner;                 ///< points that are on no side
  std::vector<std::array<std::uint32_t, 2>> segments;  ///< between any of these points
};

/// The constrained Delaunay triangulation of a facet, with the facet's orientation: the segments are edges of
/// it. Points are placed by their barycentric weights, rounded to 2^-40; points of sides are then exactly on
/// the sides. Points must be farther than this rounding from each other, and from sides and segments on which
/// they do not lie. Returns nothing if points are nearer, or if segments cross. O(n^2) at worst. Sources:
/// Lawson 1977; Sloan, A fast algorithm for generating constrained Delaunay triangulations, 1993.
std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulate(const CutFacet& facet,
                                                                     std::span<const Vec3> points);

}  // namespace vps
