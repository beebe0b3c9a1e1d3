// SPDX-License-Identifier: BSD-3-Clause
// Exact measures of two parts: clearance, depth and volume of their overlap, and the check of the pair.
#pragma once

#include <optional>

#include "surface/part_surface.h"
#include "surface/placed_surface.h"

namespace vps::scenes {

/// The least distance of two surfaces.
struct SurfaceGap {
  double distance_m = 0;  ///< most_m if the surfaces are farther apart; 0 if they touch or cross
  Vec3 p_A = Vec3::Zero(), p_B = Vec3::Zero();  ///< the nearest points, in the frame of A
};

/// The least distance over all pairs of triangles, exact to rounding, up to most_m. O(log n) typical, more
/// where large areas are equally far.
/// @param X_AB pose of B in A
SurfaceGap surfaceGap(const PartSurface& a, const PartSurface& b, const Pose& X_AB, double most_m);

/// Balls that lie inside both of two placed solids, in the frame of the first solid. Both solids must outlive
/// the object.
class SharedBalls {
 public:
  SharedBalls(const PlacedSurface& a, const PlacedSurface& b);

  /// Radius of the greatest ball around a point that lies in both solids. For a point outside one of the
  /// solids the result is negative: minus the distance from that solid. 1-Lipschitz.
  [[nodiscard]] double radiusAt(const Vec3& p_A) const;
  /// The nearer of the two surfaces, which limits the ball around a point.
  struct Limit {
    double radius_m;
    bool is_of_b;
    Vec3 out, q;  ///< unit direction out of the limiting solid; nearest point of its surface
  };
  [[nodiscard]] Limit limitAt(const Vec3& p_A) const;
  /// Moves a ball to where no small displacement makes it larger. depth_m of the result is the ball's radius.
  [[nodiscard]] Overlap grownFrom(const Vec3& p_A, double step_m) const;
  /// The largest ball found from the points of a grid; a larger ball may exist. depth_m of the result is the
  /// ball's radius, or 0 if no ball is found.
  [[nodiscard]] Overlap greatest() const;

 private:
  [[nodiscard]] Overlap grownFrom(const Vec3& p_A, Vec3 step_A) const;
  const PartSurface &a_, &b_;
  Pose X_WA_, X_BA_;
  Box both_A_;
};

/// How deep two solids penetrate each other, with a proven bound. The depth is the greater of two lengths:
/// the greatest distance from a point of one part's surface inside the other part to the other part's
/// surface, and the thickness of the shared volume, which is the diameter of the greatest ball in it. Neither
/// length depends on how a surface is divided into facets.
struct OverlapDepth {
  double depth_m = 0;         ///< depth that was found, at most the true one
  double most_m = 0;          ///< upper bound of the true depth
  Vec3 p_W = Vec3::Zero();    ///< the deepest point, or the ball's centre
  bool is_thickness = false;  ///< depth_m is the ball's diameter
};

/// Measures the depth of the overlap. `most_m` exceeds `depth_m` by the greater of 0.1 um and a
/// ten-thousandth of the depth, or by more if the search ended at its limit of work.
///
/// The method is branch and bound over both surfaces. A piece of a facet is settled if it cannot contain more
/// than the depth found so far plus this tolerance (together "enough"), for one of these reasons:
///
///   depth:      The distance at the middle of the piece plus the piece's size is at most enough, because
///               distance is 1-Lipschitz. Or the piece, moved by enough along one direction, is outside the
///               other part: each of its points is then no farther than enough from the surface.
///   thickness:  The greatest ball touches a surface somewhere, with its centre along the normal. All larger
///               balls that touch the piece have the ends of their diameters outside one of the parts, or
///               their centres too near a surface.
///
/// Other pieces are divided where two faces are equally far, else in the middle. A ball can touch a reflex
/// corner or edge from a cone of directions, which is divided as well.
///
/// The result is the same on any machine, since the limit of work is a count. The search takes one or two
/// seconds at most, or about ten where many facets are equally far, as around the centre of a ball. The bound
/// does not cover surfaces with holes, where a distance jumps by up to the hole's width.
/// @param known a depth that is known already, at most the true one
OverlapDepth overlapDepth(const PlacedSurface& a, const PlacedSurface& b, const OverlapDepth& known);

/// An overlap that does not depend on how curved faces were divided into facets.
struct CertainOverlap {
  double depth_m = 0;  ///< 0: no overlap is certain
  double error_m = 0;  ///< error of the depth at the measured point; less than the depth
  Vec3 p_W = Vec3::Zero();
};

/// Measures points on the edges of each part inside the other part, and returns the point whose depth exceeds
/// its error by most. The distance of facets from the curved faces that they approximate counts only along
/// the direction of the depth, so the overlap of two flat faces is certain, however coarse adjacent curved
/// faces are. The points are the ends, thirds and middles of the pieces of edges that are inside, so a deeper
/// overlap may be missed. O(edges near the other part x log facets).
CertainOverlap certainOverlap(const PlacedSurface& a, const PlacedSurface& b);

/// The volume that two solids share.
struct OverlapVolume {
  double volume_m3 = 0;
  double area_m2 = 0;  ///< area of the shared volume's surface
  /// Bound of the error for the meshes as they are. The error consists of the shift by kVolumeShift_m, and of
  /// the amount by which the vector areas of the volume's surface do not sum to zero. A hole of an open mesh
  /// adds its area times a sixth of the overlap's diagonal.
  double error_m3 = 0;
  double faces_error_m3 = 0;  ///< error because facets deviate from curved faces
};

/// Displacement of B before overlapVolume() measures, so that no two faces coincide.
inline constexpr double kVolumeShift_m = 1e-9;
/// Measures the shared volume by the divergence theorem, over the part of each surface that is inside the
/// other solid; the areas of these parts are exact. O(facets near the other part x log facets).
/// @param X_AB pose of B in A
OverlapVolume overlapVolume(const PartSurface& a, const PartSurface& b, const Pose& X_AB);

/// Measures overlap or clearance of two parts. Empty if the parts are farther from each other than near_m.
/// Thread-safe.
std::optional<CheckedPair> checkPair(const PlacedSurface& a, const PlacedSurface& b, double near_m);

/// Bound of the distance of a mesh from its true faces anywhere: see meshError_m(). Finite for any mesh.
double faceError_m(const PlacedSurface& part);

/// Bound of the distance of two meshes from their true faces anywhere, added: the greatest distance of facets
/// from the curved faces that they approximate (PartSurface::chordBound_m(); a prism of sixteen sides or
/// fewer counts as a prism, and its error as 0), widths of cracks, and rounding. The error of a pair's depth
/// can be smaller, since it counts only the error near the overlap. Infinite if a mesh has no inside or is
/// not closed, because a depth in such a mesh has no bound.
double meshError_m(const PlacedSurface& a, const PlacedSurface& b);

}  // namespace vps::scenes
