// SPDX-License-Identifier: BSD-3-Clause
// Exact contact of one shell point with the surfaces of the other body.
#pragma once

#include <cstdint>
#include <span>

#include "narrowphase/candidates/contact_candidate.h"
#include "narrowphase/refinement/curved_contact.h"

namespace vps::bullet {

/// A shell point and the surface of its part around it.
struct OwnPoint {
  Vec3 p_W, inward_W;
  bool is_edge = false;
  const SideView* side = nullptr;             ///< the part; null: edges are ignored
  std::span<const std::uint32_t> edges = {};  ///< indices of the part's sharp edges on which the point lies
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
  /// another point of the part is deeper in the plane, or an edge of the other part meets a face of this
  /// part.
  [[nodiscard]] bool isFirstAlong(const Vec3& n_W) const;
  /// True if runsAlong(), and the edge continues straight towards the other part for at least one more point.
  [[nodiscard]] bool leadsOn(const Vec3& n_W) const;
  /// True if the point lies on one edge (not on a corner) that runs towards the other part along this normal.
  /// The edge is then nearest where it crosses an edge of the other part, which is a candidate of its own.
  [[nodiscard]] bool runsAlong(const Vec3& n_W) const;
};

/// Exact contact of a point.
struct Exact {
  bool found = false;       ///< a surface is within reach
  bool found_all = false;   ///< every surface of the other side is within reach, so that a wider search would
                            ///< find the same contact
  bool is_contact = false;  ///< the surface faces the point, so that they touch
  bool is_inside = false;   ///< the point is behind the nearest surface, or on it
  double distance_m = 0;
  Vec3 n = Vec3::Zero();
  bool is_on_edge = false;  ///< the nearest place of the other surface lies on a sharp edge
  bool is_edge_on_edge = false;
  bool is_smooth = false;                           ///< two smooth faces touch flush
  bool is_own_face = false, is_their_face = false;  ///< the face that gives the contact plane
  bool is_curved = false;                           ///< the other part's facet approximates a curved surface
  FacePoint face;              ///< the other part's face, if is_their_face and not a primitive
  std::uint16_t surface = 0;   ///< index of the surface of the other side
  Vec3 from_q = Vec3::Zero();  ///< the point minus the nearest point of the surface
};

/// Measures one shell point against all surfaces of the other side.
struct Refiner {
  const SideView& side;
  const SideView& other;
  const btCollisionShape& theirs;
  bool is_primitive;

  /// @param max_m  surfaces farther away are ignored
  [[nodiscard]] Exact at(const OwnPoint& own, double max_m) const;
};

}  // namespace vps::bullet
