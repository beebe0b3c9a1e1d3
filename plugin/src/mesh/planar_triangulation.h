// SPDX-License-Identifier: BSD-3-Clause
// Triangulates one facet with points and segments in it, by exact predicates.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vps/pose.h"

namespace vps {

/// What a facet is cut by. Points are numbered as in a common list.
struct CutFacet {
  std::array<std::vector<std::uint32_t>, 3> sides;  ///< of each side its first corner, then the points on it
  std::vector<std::uint32_t> inner;                 ///< points that are on no side
  std::vector<std::array<std::uint32_t, 2>> segments;  ///< between any of these points
};

/// The constrained Delaunay triangulation of a facet, of its orientation: segments are edges of it. Points
/// are placed by their weights of the facet's corners, rounded to 2^-40; those of sides are then exactly on
/// them. All must be farther than that from each other and from sides and segments on which they do not lie.
/// Nothing if they are not, or if segments cross. O(n^2) at worst. Sources: Lawson 1977; Sloan, A fast
/// algorithm for generating constrained Delaunay triangulations, 1993.
std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulate(const CutFacet& facet,
                                                                     std::span<const Vec3> points);

}  // namespace vps
