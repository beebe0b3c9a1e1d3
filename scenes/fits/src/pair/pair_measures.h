// SPDX-License-Identifier: BSD-3-Clause
// Exact measures of two parts: clearance, depth and volume of their overlap, and the check of the pair.
#pragma once

#include <optional>

#include "surface/part_surface.h"
#include "surface/placed_surface.h"

namespace vps::scenes {

struct SurfaceGap {
  double distance_m = 0;  ///< at least most_m if nothing is nearer; 0 where the surfaces touch or cross
  Vec3 p_A = Vec3::Zero(), p_B = Vec3::Zero();  ///< the nearest points, in the frame of A
};

/// Exact to rounding: the least distance over all pairs of triangles. @param X_AB pose of B in A.
/// O(log n) typical, more where large areas are equally far.
SurfaceGap surfaceGap(const PartSurface& a, const PartSurface& b, const Pose& X_AB, double most_m);

/// Balls in both of two placed solids, in the frame of the first. Both must outlive it.
class SharedBalls {
 public:
  SharedBalls(const PlacedSurface& a, const PlacedSurface& b);

  /// Radius of the greatest ball around a point that is in both solids; negative outside of one of them, by
  /// the distance from it. 1-Lipschitz.
  [[nodiscard]] double radiusAt(const Vec3& p_A) const;
  /// The surface that limits that ball, which is the nearer one.
  struct Limit {
    double radius_m;
    bool is_of_b;
    Vec3 out, q;  ///< unit, out of that solid; the nearest point of its surface
  };
  [[nodiscard]] Limit limitAt(const Vec3& p_A) const;
  /// A ball that no small displacement makes larger; its radius is depth_m.
  [[nodiscard]] Overlap grownFrom(const Vec3& p_A, double step_m) const;
  /// The largest that is found from the points of a grid; there may be a larger one. Radius 0: none.
  [[nodiscard]] Overlap greatest() const;

 private:
  [[nodiscard]] Overlap grownFrom(const Vec3& p_A, Vec3 step_A) const;
  const PartSurface &a_, &b_;
  Pose X_WA_, X_BA_;
  Box both_A_;
};

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

struct CertainOverlap {
  double depth_m = 0;  ///< 0: none is certain
  double error_m = 0;  ///< at that place, less than the depth
  Vec3 p_W = Vec3::Zero();
};

/// Of some points of the edges of each part in the other: that whose depth exceeds the error of the facets
/// there by most. The distance of facets from the curved faces that they stand for counts in the direction
/// of the depth only, so that a flat face in a flat face is certain, however coarse the faces beside them
/// are. A search of ends, thirds and middles of the pieces of edges that are inside: what is found is
/// certain, but there may be more. O(edges near the other part x log facets).
CertainOverlap certainOverlap(const PlacedSurface& a, const PlacedSurface& b);

struct OverlapVolume {
  double volume_m3 = 0;
  double area_m2 = 0;  ///< of its surface
  /// A bound for the meshes: the shift, and what the vector areas of the found surface lack of zero. A hole
  /// of an open mesh adds its area times a sixth of the overlap's diagonal.
  double error_m3 = 0;
  double faces_error_m3 = 0;  ///< by the distance of the facets from the curved faces that they stand for
};

/// By the divergence theorem over the parts of each surface inside the other solid, whose areas are exact:
/// B is moved by kVolumeShift_m first, so that no two faces coincide. O(facets near the other part x log
/// facets).
inline constexpr double kVolumeShift_m = 1e-9;
OverlapVolume overlapVolume(const PartSurface& a, const PartSurface& b, const Pose& X_AB);

/// Empty if the parts are farther from each other than near_m. Thread-safe.
std::optional<CheckedPair> checkPair(const PlacedSurface& a, const PlacedSurface& b, double near_m);

/// How far the meshes of two parts may be from their true faces anywhere, both together: the greatest
/// distance of facets from the curved faces that they stand for, cracks, and rounding. No error of a pair's
/// depth is that of its meshes where a flat face shows the overlap. Infinite where one of them has no inside
/// or is not closed: a depth in it has no bound.
double meshError_m(const PlacedSurface& a, const PlacedSurface& b);

}  // namespace vps::scenes
