// SPDX-License-Identifier: BSD-3-Clause
// The exact contact of one shell point with the surfaces of the other body.
#pragma once

#include <cstdint>
#include <span>

#include "narrowphase/candidates/contact_candidate.h"
#include "narrowphase/refinement/curved_contact.h"

namespace vps::bullet {

/// A shell point and its own part's surface around it.
struct OwnPoint {
  Vec3 p_W, inward_W;
  bool is_edge = false;
  const SideView* side = nullptr;             ///< null: edges are ignored
  std::span<const std::uint32_t> edges = {};  ///< of side, on which the point lies
  Vec3 p_M = Vec3::Zero();                    ///< the point in its models' frame
  bool is_two_sided = true;                   ///< the other part's points are queried too

  OwnPoint movedTo(const Vec3& place_W) const {
    OwnPoint moved = *this;
    moved.p_W = place_W;
    return moved;
  }
  [[nodiscard]] const EdgeSegment& segment(std::uint32_t i) const {
    return side->shape->edges().segments()[i];
  }
  /// True if one of the faces beside the point's edges lies flush on a face with this normal.
  [[nodiscard]] bool isFlushOn(const Vec3& n_W) const;
  [[nodiscard]] Vec3 inModel(const Vec3& n_W) const { return side->X_WM.R.transpose() * n_W; }
  /// True if the part lies, around the point, behind the plane with this normal through the point. If not,
  /// another of its points meets the plane, and deeper; or, where the other part ends earlier, its edge meets
  /// this part's face.
  [[nodiscard]] bool isFirstAlong(const Vec3& n_W) const;
  /// True if runsAlong() and the edge is straight for at least one more point towards the other part.
  [[nodiscard]] bool leadsOn(const Vec3& n_W) const;
  /// True if the point's edge (not a corner) runs towards the other part along this normal: the edge is then
  /// nearer where the edges cross, which is a candidate of its own.
  [[nodiscard]] bool runsAlong(const Vec3& n_W) const;
};

/// What a point meets.
struct Exact {
  bool found = false;      ///< there is a surface within reach
  bool found_all = false;  ///< every surface of the other side is within reach: a wider search finds the same
  bool is_contact = false;  ///< the surface faces the point
  bool is_inside = false;   ///< the point is behind the nearest surface, or on it
  double distance_m = 0;
  Vec3 n = Vec3::Zero();
  bool is_on_edge = false;  ///< the nearest place of the other surface lies on a sharp edge
  bool is_edge_on_edge = false;
  bool is_smooth = false;                           ///< two faces touch flush
  bool is_own_face = false, is_their_face = false;  ///< whose the plane is
  bool is_curved = false;                           ///< the other's face stands for a curved surface
  FacePoint face;                                   ///< if is_their_face, and no primitive's: the other's
  std::uint16_t surface = 0;                        ///< index of the other's surface
  Vec3 from_q = Vec3::Zero();                       ///< the point minus its foot
};

/// Exact contact of one shell point with all surfaces of the other side.
struct Refiner {
  const SideView& side;
  const SideView& other;
  const btCollisionShape& theirs;
  bool is_primitive;

  /// @param max_m  surfaces farther away are not looked at
  [[nodiscard]] Exact at(const OwnPoint& own, double max_m) const;
};

}  // namespace vps::bullet
