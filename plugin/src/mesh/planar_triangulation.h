// SPDX-License-Identifier: BSD-3-Clause
// Triangulates a facet together with points and segments in it, by exact predicates.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vps/pose.h"

namespace vps {

/// A facet with the points and segments that cut it. Points are numbered as in a common list.
struct CutFacet {
  std::array<std::vector<std::uint32_t>, 3> sides;  ///< of each side its first corner, then the points on it
  std::vector<std::uint32_t> inner;                 ///< points that are on no side
  std::vector<std::array<std::uint32_t, 2>> segments;  ///< between any of these points
};

/// The constrained Delaunay triangulation of a facet, with the facet's orientation: the segments are edges of
/// it. Points are placed by their barycentric weights, rounded to 2^-40; points of sides are then exactly on
/// the sides. Points must be farther than that from each other, and from sides and segments on which they do
/// not lie. Returns nothing if they are nearer, or if segments cross. O(n^2) at worst. Sources: Lawson 1977;
/// Sloan, A fast algorithm for generating constrained Delaunay triangulations, 1993.
std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulate(const CutFacet& facet,
                                                                     std::span<const Vec3> points);

}  // namespace vps
