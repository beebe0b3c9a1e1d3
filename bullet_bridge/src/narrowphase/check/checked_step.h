// SPDX-License-Identifier: BSD-3-Clause
// Internals of PairCheck: the solved step, and vertices of curved faces.
#pragma once

#include <span>
#include <vector>

#include "narrowphase/candidates/contact_candidate.h"
#include "narrowphase/check/contact_at_pose.h"
#include "narrowphase/check/pair_check.h"
#include "narrowphase/check/step_path.h"
#include "narrowphase/pair/pair_view.h"
#include "vps/contact_tolerances.h"
#include "vps_bullet/turn.h"

namespace vps::bullet {

/// The pair at given poses, which differ from Bullet's present ones.
struct PairCheck::Placed {
  btTransform X_WS[2];
  btCollisionObjectWrapper wrapper0, wrapper1;
  PairView pair;

  Placed(const PairCheck& check, const Pose (&X)[2])
      : X_WS{toBt(X[0]), toBt(X[1])},
        wrapper0(nullptr, check.shape_[0], check.object_[0], X_WS[0], -1, -1),
        wrapper1(nullptr, check.shape_[1], check.object_[1], X_WS[1], -1, -1),
        pair(&wrapper0, &wrapper1) {}
  Placed(const Placed&) = delete;
  Placed& operator=(const Placed&) = delete;
};

/// The solved step.
struct PairCheck::Motion {
  Pose start[2], end[2];        ///< poses of the shapes
  Displacement step;            ///< motion from start to end
  Displacement since_selected;  ///< motion from the poses of the selection to the end
  double tolerated_m = 0;
  double travel_m = 0;  ///< greatest displacement of a point of the smaller body relative to the other body
  double deviation_m = 0;  ///< greatest distance of a point from the position that the selection predicted
  double turn_rad = 0, turn_deviation_rad = 0;  ///< rotation, and its difference from the predicted one
  StepPath path;
  Vec3 center_W = Vec3::Zero();  ///< centre of the smaller body at the start
  double radius_m = 0;           ///< radius of the smaller body
  Vec3 moved_W = Vec3::Zero(),
       turned = Vec3::Zero();  ///< displacement and rotation of body 0 relative to body 1
  double bend_m = 0;           ///< greatest distance of a point's path from its tangent

  /// True if, after `share` of the step, the bodies still turn too far against each other for planes to be
  /// carried along: on a curved face another plane becomes the nearest.
  [[nodiscard]] bool turnsFar(double share) const { return (1 - share) * turn_rad > kContactTurn_rad; }
};

/// True if the overlap at the end of the step is more than tolerated and has grown.
inline bool isMissed(double start_m, double end_m, double tolerated_m) {
  return end_m < -tolerated_m && end_m < start_m - kGrowthShare * tolerated_m;
}

/// Moves candidates of curved faces to the deepest vertex of their facet, if that vertex protrudes enough and
/// is deeper in the other body than the candidate. Distance and normal are then those of the vertex, exactly.
/// At most one candidate is moved to each vertex.
/// @param candidates  refined at the pair's poses
/// @param contact_margin_m  Settings::contact_margin_m
void moveToFacetCorners(const PairView& pair, double contact_margin_m, std::vector<Candidate>& candidates);

/// True if one of the points lies on a facet whose vertices protrude enough to matter.
bool haveFacetCorners(const PairView& pair, double contact_margin_m, std::span<const Candidate> candidates);

}  // namespace vps::bullet
