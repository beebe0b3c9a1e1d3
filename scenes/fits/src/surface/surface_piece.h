// SPDX-License-Identifier: BSD-3-Clause
// Convex pieces of facets, and whether such a piece is outside a solid.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "surface/part_surface.h"

namespace vps::scenes {

/// A flat convex polygon as its corners in order. Two corners are a segment, one corner is a point.
using SurfacePiece = std::vector<Vec3>;

/// The mean of the corners.
Vec3 middleOf(const SurfacePiece& piece);
/// The greatest distance of a corner from the point p.
double reachFrom(const Vec3& p, const SurfacePiece& piece);
/// The piece transformed by a pose, and the piece displaced by a vector.
SurfacePiece placed(const SurfacePiece& piece, const Pose& X);
SurfacePiece shifted(const SurfacePiece& piece, const Vec3& by);
/// The part of a polygon where n . p <= level; may be empty.
SurfacePiece below(const SurfacePiece& piece, const Vec3& n, double level);

/// The range, as fractions of the segment pq, in which the segment is inside a convex polygon in whose plane
/// it lies. The first fraction exceeds the second if the segment is outside.
/// @param n normal of any length, around which the polygon's corners run counter-clockwise
std::pair<double, double> sharesWithin(std::span<const Vec3> polygon, const Vec3& n, const Vec3& p,
                                       const Vec3& q);

/// Whether the piece is outside the surface's solid and meets none of its facets. The result is also false in
/// doubtful cases, such as polygons in the plane of a facet.
/// @param n     normal of the polygon's plane
/// @param work counts the visited nodes and facets, which take about 10 ns each
bool isOutside(const SurfacePiece& piece, const Vec3& n, const PartSurface& surface, std::size_t& work);

}  // namespace vps::scenes
