// SPDX-License-Identifier: BSD-3-Clause
// Convex pieces of facets, and whether one is outside of a solid.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "surface/part_surface.h"

namespace vps::scenes {

/// Corners of a flat convex polygon in order; two are a segment, one is a point.
using SurfacePiece = std::vector<Vec3>;

/// The corners' mean.
Vec3 middleOf(const SurfacePiece& piece);
/// The greatest distance of a corner from the point.
double reachFrom(const Vec3& p, const SurfacePiece& piece);
SurfacePiece placed(const SurfacePiece& piece, const Pose& X);
SurfacePiece shifted(const SurfacePiece& piece, const Vec3& by);
/// The part of a polygon where n . p <= level; empty if none.
SurfacePiece below(const SurfacePiece& piece, const Vec3& n, double level);

/// The shares, from 0 to 1, of a segment pq between which it is in a convex polygon in whose plane it lies;
/// the first is more than the second where it is not.
/// @param n  of the polygon, around which its corners run counter-clockwise; of any length
std::pair<double, double> sharesWithin(std::span<const Vec3> polygon, const Vec3& n, const Vec3& p,
                                       const Vec3& q);

/// Whether the piece is outside of the surface's solid and meets none of its facets. "No" is also the answer
/// where it cannot be told, as for polygons in the plane of a facet.
/// @param n     normal of the polygon's plane
/// @param work  counts the nodes and facets that are visited, of some 10 ns each
bool isOutside(const SurfacePiece& piece, const Vec3& n, const PartSurface& surface, std::size_t& work);

}  // namespace vps::scenes
