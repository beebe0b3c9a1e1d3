// SPDX-License-Identifier: BSD-3-Clause
// Where two curved faces are nearest: between the points of their shells.
#pragma once

#include "narrowphase/contact_candidate.h"

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

}  // namespace vps::bullet
