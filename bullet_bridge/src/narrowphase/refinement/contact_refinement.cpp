// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <span>

#include "narrowphase/refinement/curved_contact.h"
#include "narrowphase/refinement/exact_contact.h"
#include "native_shapes/native_shape.h"
#include "native_shapes/native_shape_adapter.h"
#include "vps/contact_tolerances.h"
#include "vps/feature_motion.h"

namespace vps::bullet {

namespace {

// Contact of a point that is inside the other body near one of that body's edges and does not satisfy
// isFirstAlong() for the nearest face. Example: a corner slides down a wall, a micrometre inside, to the
// wall's lower rim. Such a point entered through another face at the edge. A point on the edge is treated
// alike: where edges lie flush, rounding decides on which side the point is, and the next face would be half
// a millimetre deep.
Exact besideEdge(const Refiner& refiner, const OwnPoint& own, double reach_m) {
  Exact best;
  if (!refiner.other.shape) return best;
  const EdgeSet& edges = refiner.other.shape->edges();
  const Pose& X_WM = refiner.other.X_WM;
  const Vec3 p = X_WM.inverse() * own.p_W;
  edges.tree().forEachNear(p, reach_m, [&](std::uint32_t i) {
    const EdgeSegment& s = edges.segments()[i];
    const Vec3 r = p - s.from, way = s.to - s.from;
    if (r.dot(way) < 0 || r.dot(way) > way.squaredNorm()) return;
    for (const int face : {0, 1}) {
      const Vec3 n = s.normal(face);
      const double distance_m = n.dot(r);
      if (distance_m > kSamePlace_m || r.dot(s.into[face]) < -kSamePlace_m ||
          (best.found && distance_m <= best.distance_m))
        continue;
      // An edge that runs through the face's plane continues behind the plane.
      if (!own.isFirstAlong(X_WM.R * n) || own.runsAlong(X_WM.R * n)) continue;
      best.found = best.is_contact = best.is_their_face = true;
      best.distance_m = distance_m;
      best.n = X_WM.R * n;
      best.surface = s.owner;
    }
  });
  return best;
}

// True if a point beside an edge passes the edge no lower than the rest gap below the plane that it meets at
// the end of the step. Such a point slides onto the face.
bool slidesOnto(const Exact& end, const Exact& now, const Vec3& way_W) {
  const double height_m = end.distance_m - end.n.dot(way_W);
  const Vec3 beside = now.from_q - now.from_q.dot(end.n) * end.n;
  const double nearer_m2 = -way_W.dot(beside);
  if (height_m < -FeatureMotion::kRest_m || !(nearer_m2 > 0)) return false;
  const double share = std::min(beside.squaredNorm() / nearer_m2, 1.0);
  return height_m + share * end.n.dot(way_W) >= -FeatureMotion::kRest_m;
}

// The line between two edges turns fast as they pass each other, and would stop a point that is about to pass
// without contact. The contact is therefore taken from the surface that the point faces at the end of the
// step, unless the point overlaps it there. The plane of that surface may lie beyond the point's present
// position by the free motion of the step. Such a surface must not push, so the contact is no deeper than it
// is now.
Exact atEndOfStep(const Exact& now, const Refiner& refiner, const OwnPoint& own, const Vec3& way_W,
                  double max_m) {
  Exact end = refiner.at(own.movedTo(own.p_W + way_W), max_m + way_W.norm());
  if (end.found && !(end.is_contact && (end.distance_m >= 0 || slidesOnto(end, now, way_W)))) return now;
  end.distance_m = std::max(end.distance_m - end.n.dot(way_W), std::min(0.0, now.distance_m));
  return end;
}

// Sets Candidate::curvature_per_m and hollow_per_m.
void setCurvature(Candidate& c, const Exact& exact, const SideView& side) {
  c.curvature_per_m = c.hollow_per_m = 0;
  if (!exact.is_contact || !exact.is_their_face || !exact.face.surface) return;
  const Mat3 theirs = exact.face.curvature_W();
  if (exact.is_curved) c.hollow_per_m = std::max(-Curvature(theirs).least_per_m, 0.0);
  if (!exact.is_smooth || side.shape->models().surfaces.empty()) return;
  const FacePoint own = ownFace(c, side);
  if (!own.surface->sheet)
    c.curvature_per_m = std::max(Curvature(theirs + own.curvature_W()).most_per_m, 0.0);
}

// True if a point of a flat face lies on a flat face or on an edge of the other part.
bool isFlat(const Candidate& c, const Exact& exact, const SideView& side) {
  const bool is_on_flat = exact.is_smooth && !exact.is_curved,
             is_on_edge = exact.is_own_face && exact.is_on_edge;
  if (!exact.is_contact || !(is_on_flat || is_on_edge) || side.shape->models().surfaces.empty()) return false;
  const Shape::PointFace own = side.shape->faceAt(c.id);
  return !side.shape->features().isCurved(own.surface, own.triangle) &&
         !side.shape->models().surfaces[own.surface].sheet;
}

}  // namespace

void refine(std::vector<Candidate>& candidates, const SideView& side, const SideView& other,
            const btCollisionShape& theirs, const RelativeMotion& motion, bool is_two_sided) {
  const bool is_primitive = isPrimitive(theirs);
  if (!is_primitive && other.shape->models().surfaces.empty()) return;
  const Refiner refiner{side, other, unwrapped(theirs), is_primitive};
  const PointShell& shell = *side.shape->models().shell;
  const double sign = side.side == 0 ? 1 : -1;
  // The field's error is below a voxel; a surface farther away is not the one that the field measured.
  const double field_error_m =
      other.shape && other.shape->models().map ? other.shape->models().map->voxel_m() : kSamePlace_m;
  // The line between edges that do not touch yet turns as the edges pass each other. Used as a contact
  // normal, this line would stop a body that slides over the seam of two plates. The check of the solved step
  // finds edges that meet.
  const bool leaves_edges = motion.is_checked && side.shape && other.shape &&
                            !side.shape->features().isEmpty() && !other.shape->features().isEmpty();
  constexpr double kResting_m = FeatureMotion::kKeptGaps * FeatureMotion::kRest_m;
  for (Candidate& c : candidates) {
    if (c.side != side.side || c.isCrossing()) continue;
    if (is_primitive && refineOnRound(c, side, other, refiner.theirs)) continue;
    const OwnPoint own{c.p_W,
                       side.X_WM.R * shell.inward[c.id],
                       side.shape->isEdgePoint(c.id),
                       &side,
                       is_primitive ? std::span<const std::uint32_t>() : side.shape->edgesAt(c.id),
                       shell.points[c.id],
                       is_two_sided};
    const double max_m = std::abs(c.distance_m) + field_error_m;
    Exact exact = refiner.at(own, std::abs(c.distance_m) + kFaceError_voxels * field_error_m);
    if (!exact.is_contact && !exact.found_all) exact = refiner.at(own, max_m);
    // Outside an edge the field may read less than half of the distance, with a normal that no face has. A
    // plane of the field would then stop or lift a body that does not come near the point.
    if (!exact.found)
      if (Candidate by_field = c; motion.canTouch(by_field))
        exact = refiner.at(own, max_m + motion.dt_s * motion.velocityAt(c.p_W).norm());
    if (!exact.found) continue;  // only the field is known
    if (!exact.is_contact && exact.is_inside && !own.edges.empty())
      if (const Exact beside = besideEdge(refiner, own, max_m); beside.found) exact = beside;
    if (exact.is_contact && exact.is_edge_on_edge && leaves_edges && exact.distance_m > kResting_m)
      exact.is_contact = false;
    if (exact.is_contact && exact.is_edge_on_edge)
      exact = atEndOfStep(exact, refiner, own, sign * motion.dt_s * motion.velocityAt(c.p_W), max_m);
    c.distance_m = exact.is_contact ? exact.distance_m : kOutOfReach_m;
    c.n_W = sign * exact.n;
    if (exact.is_contact) c.surface[1 - c.side] = exact.surface;
    c.is_flush = exact.is_curved && own.isFlushOn(exact.n);
    c.plane_of = exact.is_own_face     ? side.side
                 : exact.is_their_face ? static_cast<std::uint8_t>(1 - side.side)
                                       : Candidate::kBetween;
    setCurvature(c, exact, side);
    c.is_flat = isFlat(c, exact, side);
    const bool is_query = motion.dt_s == 0;
    if (exact.is_contact && exact.is_own_face && is_query && !exact.is_inside)
      moveToClosest(c, side, exact.from_q);
    else if (exact.is_contact && exact.is_own_face && !is_primitive)
      moveToFoot(c, side, exact.from_q);
    if (exact.is_contact && exact.is_smooth && !is_primitive)
      moveToNearest(c, side, other, exact.face, motion.contact_margin_m + kFaceError_voxels * field_error_m);
  }
}

namespace {

Exact nearFieldDistance(const Refiner& refiner, const Vec3& p_W, const Vec3& inward, double field_m,
                        double voxel_m) {
  const OwnPoint own{p_W, inward, true};  // penalty contact has no crossings, only the points of edges
  Exact exact = refiner.at(own, std::abs(field_m) + kFaceError_voxels * voxel_m);
  if (!exact.found) exact = refiner.at(own, std::abs(field_m) + voxel_m);
  return exact;
}

}  // namespace

void refineEdges(std::vector<Candidate>& candidates, const SideView& side, const SideView& other,
                 const btCollisionShape& theirs, const Pose (&way)[2], const RelativeMotion& motion) {
  if (isPrimitive(theirs) || !other.shape->models().map || other.shape->models().surfaces.empty()) return;
  const VoxMap& map = *other.shape->models().map;
  const PointShell& shell = *side.shape->models().shell;
  const double sign = side.side == 0 ? 1 : -1;
  const int i = side.side, j = 1 - i;
  const SideView other_then{other.shape, way[j] * other.X_WM, other.side};
  const Pose X_MW = other_then.X_WM.inverse();
  const Refiner now{side, other, theirs, false}, then{side, other_then, theirs, false};
  for (Candidate& c : candidates) {
    if (c.side != side.side || !side.shape->isEdgePoint(c.id)) continue;
    const Vec3 inward = side.X_WM.R * shell.inward[c.id], p_then_W = way[i] * c.p_W;
    const double field_m = map.distance(X_MW * p_then_W);
    if (field_m > kEdgeError_voxels * map.voxel_m()) continue;
    Exact exact = nearFieldDistance(then, p_then_W, way[i].R * inward, field_m, map.voxel_m());
    if (exact.found && exact.is_contact &&
        exact.distance_m >= std::min(0.0, c.distance_m) - motion.contact_margin_m) {
      exact.distance_m -= exact.n.dot((p_then_W - c.p_W) - (way[j] * c.p_W - c.p_W));
    } else {
      exact = nearFieldDistance(now, c.p_W, inward, c.distance_m, map.voxel_m());
      if (!exact.found) continue;
    }
    c.distance_m = exact.is_contact ? exact.distance_m : kOutOfReach_m;
    c.n_W = sign * exact.n;
    if (exact.is_contact) c.surface[1 - c.side] = exact.surface;
  }
}

void useOwnNormals(std::vector<Candidate>& candidates, const SideView& side) {
  const double sign = side.side == 0 ? 1 : -1;
  std::erase_if(candidates, [&](Candidate& c) {
    if (c.side != side.side || side.shape->isEdgePoint(c.id)) return false;
    const Vec3 own = sign * (side.X_WM.R * side.shape->smoothInward(c.id));
    const double facing = own.dot(c.n_W);
    if (facing <= kSinGrazing) return true;
    c.distance_m *= facing;  // distance of the tangent plane at the nearest point
    c.n_W = own;
    return false;
  });
}

}  // namespace vps::bullet
