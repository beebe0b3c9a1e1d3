// SPDX-License-Identifier: BSD-3-Clause
// Contact of curved faces between the points of their shells.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "narrowphase/candidates/contact_candidate.h"
#include "narrowphase/pair/pair_view.h"

namespace vps::bullet {

/// A point of a face, with the normal of the curved surface that the facets approximate.
struct FacePoint {
  Vec3 q_W = Vec3::Zero(), outward_W = Vec3::Zero();
  const Surface* surface = nullptr;
  Mat3 R_WP = Mat3::Identity();
  std::uint32_t triangle = 0;

  [[nodiscard]] Mat3 curvature_W() const {
    return R_WP * surface->distance->smoothCurvature(triangle) * R_WP.transpose();
  }
};

/// The face on which a candidate's shell point lies. Requires surfaces, and a point that is not on an edge.
FacePoint ownFace(const Candidate& c, const SideView& side);

/// Moves a candidate along its part's surface to the place of least gap to the other curved surface, if that
/// place is within the shell's spacing. p_W, distance and normal are then measured at the new place, on the
/// exact surfaces. Without this step a ball of 5 mm with points 0.5 mm apart lies 12 um deeper between its
/// points, and the normals of the points around the contact lean by 0.05 rad, which is felt in sliding.
/// @param c  refined candidate of a point on a face; its normal is that of the other surface at the nearest
/// point
/// @param their  nearest point of the other surface, on one of its faces
/// @param max_gain_m  greatest accepted decrease of the gap. Candidates are found by the gaps of their
/// points,
///   so a contact whose gap decreases by more than the search margin would appear and disappear.
/// If Newton's method does not converge, as at the hub of a fan of facets, the nearest of the tried places is
/// taken.
/// @return false if the candidate is unchanged. Flat and conforming faces (a peg in its bore) need no surface
/// query, others two to four.
/// Source: Newton's method for the common normal, with the curvature of both
/// (Johnson, Contact Mechanics, 1985, section 4.1: the gap between two surfaces).
bool moveToNearest(Candidate& c, const SideView& side, const SideView& other, const FacePoint& their,
                   double max_gain_m);

/// Moves a candidate to the place of its part's curved surface that is nearest to a point q near an edge of
/// the other surface. p_W, distance and normal are then measured at the new place. The plane at the shell's
/// point, up to a spacing away, would lie outside a round face, and lean.
/// @param from_q_W  p - q
/// @return false if the candidate is unchanged, since the face is flat or the nearest place is not on a face
bool moveToFoot(Candidate& c, const SideView& side, const Vec3& from_q_W);

/// Moves a candidate to the place of its part that is nearest to a point q of the other surface; distance and
/// normal are then measured between these two points. For queries: from far away, the plane of a slanted face
/// is much nearer than the face.
/// @param from_q_W  p - q
void moveToClosest(Candidate& c, const SideView& side, const Vec3& from_q_W);

/// Greatest distance by which the nearest shell point of a face can be farther from a primitive's round side
/// than the contact itself: s^2 / (2 r) for points s apart on a ball of radius r, at most s. 0 for primitives
/// without a round side.
double roundReach_m(const btCollisionShape& primitive, double spacing_m);

/// Moves a candidate of `side` on a face from its shell point to the place where that face touches the
/// primitive, if that place is nearer. The place is found as the primitive's extreme point against the face's
/// normal and the nearest point of the part's exact surface. The extreme point belongs to the primitive's
/// solid, so the distance is never less than the true one. The distance is exact for a flat face. Returns
/// false, and changes nothing, for points on edges, parts without exact surfaces, flat sides of primitives,
/// and where the distance would not decrease.
bool refineOnRound(Candidate& c, const SideView& side, const SideView& other,
                   const btCollisionShape& primitive);

/// Greatest and least curvature of a curved surface [1/m]; convex is positive, a plane has none.
struct Curvature {
  double most_per_m = 0, least_per_m = 0;

  Curvature() = default;
  /// @param turn_per_m  derivative of the outward normal by displacements in the tangent plane: symmetric,
  /// zero along the normal
  explicit Curvature(const Mat3& turn_per_m);
};

/// Greatest difference between the gap at the nearest shell point and the least gap between shell points [m].
/// Every place of a face has a shell point within the spacing, and over that distance the gap of two surfaces
/// rises at most by this parabola.
/// @param curvature_per_m  greatest sum of both surfaces' curvatures
inline double samplingError_m(double spacing_m, double curvature_per_m) {
  return 0.5 * spacing_m * spacing_m * std::max(curvature_per_m, 0.0);
}

/// Sampling error of points for which only the field's value is known. The curvature of the own face is taken
/// at the point, that of the other body as the greatest around its own near points.
class SamplingError {
 public:
  /// @param near  points of both sides
  SamplingError(const PairView& pair, std::span<const Candidate> near);
  /// Zero for points on edges, crossings and parts without surfaces.
  [[nodiscard]] double of_m(const Candidate& c) const;

 private:
  const PairView& pair_;
  std::array<double, 2> most_per_m_{0, 0};
};

}  // namespace vps::bullet
