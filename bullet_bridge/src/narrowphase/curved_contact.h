// SPDX-License-Identifier: BSD-3-Clause
// Where two curved faces are nearest: between the points of their shells.
#pragma once

#include "narrowphase/contact_candidate.h"

namespace vps::bullet {

/// Faces whose normals are within 20 degrees of opposite touch flush.
inline constexpr double kCosFlush = 0.94;

/// A point of a face, as the curved surface that the facets stand for.
struct FacePoint {
  Vec3 q_W = Vec3::Zero(), outward_W = Vec3::Zero();
  const Surface* surface = nullptr;
  Mat3 R_WP = Mat3::Identity();
  std::uint32_t triangle = 0;

  [[nodiscard]] Mat3 curvature_W() const {
    return R_WP * surface->distance->smoothCurvature(triangle) * R_WP.transpose();
  }
};

/// Moves a face's point along its part's surface to where the gap to the other's curved surface is least, if
/// that is within the shell's spacing of it: p_W, distance and normal become those there, on the exact
/// surfaces. A ball of 5 mm with points 0.5 mm apart lies 12 um deeper between them, and the normals of
/// points beside the contact lean by 0.05 rad, which a hand that slides it feels.
/// @param c  corrected, of a point on a face: its normal is the other's at the point's foot
/// @param their  that foot, on a face
/// @param most_gain_m  by how much the gap may be less there: candidates are found by their points' gaps, and
///                     what is nearer by more than the slack that they are looked for with would come and go
/// @return false: left as it was. Flat and conforming faces (a peg in its bore) cost no look at a surface;
/// others two to four.
/// Source: Newton's method for the common normal, with the curvature of both (Johnson, Contact Mechanics,
/// 1985, section 4.1: the gap between two surfaces).
bool moveToNearest(Candidate& c, const SideView& side, const SideView& other, const FacePoint& their,
                   double most_gain_m);

}  // namespace vps::bullet
