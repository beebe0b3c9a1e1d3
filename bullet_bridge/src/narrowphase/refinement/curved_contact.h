// SPDX-License-Identifier: BSD-3-Clause
// Contact of curved faces between the points of their shells.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "narrowphase/candidates/contact_candidate.h"
#include "narrowphase/pair/pair_view.h"

namespace vps::bullet {

/// A point of a face, on the curved surface that the facets approximate.
struct FacePoint {
  Vec3 q_W = Vec3::Zero(), outward_W = Vec3::Zero();
  const Surface* surface = nullptr;
  Mat3 R_WP = Mat3::Identity();
  std::uint32_t triangle = 0;

  [[nodiscard]] Mat3 curvature_W() const {
    return R_WP * surface->distance->smoothCurvature(triangle) * R_WP.transpose();
  }
};

/// The place of a candidate's shell point on its own face. Requires surfaces and a point on a face.
FacePoint ownFace(const Candidate& c, const SideView& side);

/// Moves a face's point along its part's surface to where the gap to the other curved surface is least, if
/// that is within the shell's spacing: p_W, distance and normal become those at that place, on the exact
/// surfaces. Without it, a ball of 5 mm with points 0.5 mm apart lies 12 um deeper between its points, and
/// the normals of the points around the contact lean by 0.05 rad, which is felt when sliding over it.
/// @param c           refined, of a point on a face: its normal is the other surface's at the point's foot
/// @param their       that foot, on a face
/// @param max_gain_m  greatest accepted decrease of the gap: candidates are searched by the gaps of their
///                    points, so a contact that is nearer by more than the search reaches beyond what touches
///                    would appear and disappear
/// Where Newton's method does not settle, as at the hub of a fan, whose normals are those of its facets, it
/// is the nearest of the places that were tried.
/// @return false: unchanged. Flat and conforming faces (a peg in its bore) need no surface query, others two
/// to four.
/// Source: Newton's method for the common normal, with the curvature of both (Johnson, Contact Mechanics,
/// 1985, section 4.1: the gap between two surfaces).
bool moveToNearest(Candidate& c, const SideView& side, const SideView& other, const FacePoint& their,
                   double max_gain_m);

/// Moves a face's point to the place of its part's curved surface nearest to a point q of the other surface,
/// whose edge is near: p_W, distance and normal become those at that place. The face's plane at the shell's
/// point, up to a spacing away, would lie outside a round face, and lean.
/// @param from_q_W  p - q
/// @return false: unchanged, since the face is flat or no face is nearest
bool moveToFoot(Candidate& c, const SideView& side, const Vec3& from_q_W);

/// Moves a face's point to the place of its part nearest to a point q of the other surface; distance and
/// normal become those between the two. For queries: seen from afar, the plane of a face that leans away is
/// much nearer than the face.
/// @param from_q_W  p - q
void moveToClosest(Candidate& c, const SideView& side, const Vec3& from_q_W);

/// How much farther than the contact itself the nearest shell point of a face can be from a primitive's round
/// side: s^2 / (2 r) for points s apart on a ball of radius r, at most s. 0 for primitives without a round
/// side.
double roundReach_m(const btCollisionShape& primitive, double spacing_m);

/// Moves a candidate of `side` on a face from its shell point to where that face touches the primitive, if
/// that is nearer: the primitive's farthest point against the face's normal, near the candidate, and its foot
/// on the part's exact surface. That point belongs to the primitive's solid, so the distance found is never
/// less than the true one. Exact for a flat face. Returns false, and changes nothing, for points on edges,
/// parts without exact surfaces, flat sides of primitives, and where the distance would not decrease.
bool refineOnRound(Candidate& c, const SideView& side, const SideView& other,
                   const btCollisionShape& primitive);

/// Greatest and least curvature of a curved surface [1/m]; convex is positive, a plane has none.
struct Curvature {
  double most_per_m = 0, least_per_m = 0;

  Curvature() = default;
  /// @param turn_per_m  turn of the outward normal along ways in its plane: symmetric, zero along the normal
  explicit Curvature(const Mat3& turn_per_m);
};

/// How much nearer two bodies may be between points of a shell than at the nearest of these [m]. Every place
/// has a point of its face within the spacing; there the gap of two surfaces has risen by this parabola at
/// most.
/// @param curvature_per_m  greatest sum of both surfaces' curvatures
inline double samplingError_m(double spacing_m, double curvature_per_m) {
  return 0.5 * spacing_m * spacing_m * std::max(curvature_per_m, 0.0);
}

/// The same of points whose readings alone are known: their own face curves as it does around them, and the
/// other's as it does most around its own near points.
class SamplingError {
 public:
  /// @param near  points of both sides
  SamplingError(const PairView& pair, std::span<const Candidate> near);
  /// Zero of points on edges, of crossings and of parts without surfaces.
  [[nodiscard]] double of_m(const Candidate& c) const;

 private:
  const PairView& pair_;
  std::array<double, 2> most_per_m_{0, 0};
};

}  // namespace vps::bullet
