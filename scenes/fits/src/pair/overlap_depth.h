// SPDX-License-Identifier: BSD-3-Clause
// How deep two solids are in each other, with a proven bound.
#pragma once

#include "surface/placed_surface.h"

namespace vps::scenes {

/// The depth is the greater of two lengths, neither of which depends on how a surface is divided into facets:
/// the greatest distance from a point of one part's surface inside the other part to the other's surface, and
/// the thickness of what both parts share, the diameter of the greatest ball in it.
struct OverlapDepth {
  double depth_m = 0;         ///< that was found, at most the true one
  double most_m = 0;          ///< the true depth is at most this
  Vec3 p_W = Vec3::Zero();    ///< the deepest point, or the ball's centre
  bool is_thickness = false;  ///< depth_m is the ball's diameter
};

/// `most_m` is `depth_m` and 0.1 um or a ten-thousandth, or more where the search ended at its limit.
///
/// Branch and bound over both surfaces. A piece of a facet is settled where it cannot hold more than has been
/// found and that much:
///
///   depth:      by the distance at its middle and its size, since distance is 1-Lipschitz; or because the
///               piece, moved by that much along one direction, is outside the other part: each of its points
///               is then no farther from the surface
///   thickness:  the ball touches a surface somewhere, its centre along the normal. The ends of the diameters
///               of all larger balls that touch the piece are outside one of the parts; or their centres are
///               too near a surface
///
/// Others are divided: where two faces are equally far, else in the middle. Corners and edges that point into
/// the part are touched in a cone of directions, which is divided as well.
///
/// The same on any machine: its limit is a count, of a second or two, and of some ten where many facets are
/// equally far, as around the centre of a ball. In surfaces with holes a distance jumps by up to their width,
/// which is not in the bound.
/// @param known  a depth that was found in some other way, at most the true one
OverlapDepth overlapDepth(const PlacedSurface& a, const PlacedSurface& b, const OverlapDepth& known);

}  // namespace vps::scenes
