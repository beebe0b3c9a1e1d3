// SPDX-License-Identifier: BSD-3-Clause
// Which edges and facets count as sharp, as curved and as flat.
#pragma once

namespace vps::inline v0 {

/// Faces that turn by more meet at a sharp edge; an edge goes on in another one that turns by less: 20
/// degrees, as PointShellSettings::edge_angle_rad.
inline constexpr double kCosSharp = 0.94;
/// Facets and segments that turn by less stand for something curved, if they turn at all. assumed: 8 degrees,
/// a polygon of 45 corners. A coarser one is met as it is: chain links of 10 corners gained energy along the
/// normals of curves, since their gap is that of the segments.
inline constexpr double kCosCurved = 0.9903;
/// An edge that stands out by less between two facets is left to the points of shells: half of what
/// parts may overlap, 1 um. By angle alone a finely meshed ball would sink into a plate by what its corners
/// stand out between the points.
inline constexpr double kLeastProtrusion_m = 0.5e-6;

/// Sine; assumed: above the rounding of files in single precision.
inline constexpr double kFlat = 1e-4;

}  // namespace vps::inline v0
