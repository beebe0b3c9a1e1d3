// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <span>

#include "narrowphase/contact_candidate.h"
#include "narrowphase/curved_contact.h"
#include "narrowphase/round_contact.h"
#include "narrowphase/sampling_error.h"
#include "native_shapes/native_shape_adapter.h"
#include "native_shapes/primitive.h"
#include "shape/sheet_border.h"
#include "vps/contact_tolerances.h"
#include "vps/feature_motion.h"

namespace vps::bullet::inline v0 {

namespace {

constexpr double kNever_m = 1;  // farther than any step moves

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
  [[nodiscard]] bool isFlushOn(const Vec3& n_W) const {
    const Vec3 n = inModel(n_W);
    for (const std::uint32_t i : edges)
      if (n.dot(segment(i).normal(0)) < -kCosSameFace || n.dot(segment(i).normal(1)) < -kCosSameFace)
        return true;
    return false;
  }
  [[nodiscard]] Vec3 inModel(const Vec3& n_W) const { return side->X_WM.R.transpose() * n_W; }
  /// True if the part lies, around the point, behind the plane with this normal through the point. If not,
  /// another of its points meets the plane, and deeper; or, where the other part ends earlier, its edge meets
  /// this part's face.
  [[nodiscard]] bool isFirstAlong(const Vec3& n_W) const {
    const Vec3 n = inModel(n_W);
    // Around a corner the part lies within the cone of its edges. A face may fall off across one of them, as
    // on a slanted tetrahedron, and yet the corner is lowest.
    const bool is_corner = edges.size() >= 3;
    for (const std::uint32_t i : edges) {
      const EdgeSegment& s = segment(i);
      if (!is_corner && std::min(n.dot(s.into[0]), n.dot(s.into[1])) < -kSinGrazing) return false;
      const Vec3 along = (s.to - s.from).normalized();
      if ((p_M - s.from).norm() < kSamePlace_m && n.dot(along) < -kSinGrazing) return false;
      if ((p_M - s.to).norm() < kSamePlace_m && n.dot(along) > kSinGrazing) return false;
    }
    return true;
  }
  /// True if runsAlong() and the edge is straight for at least one more point towards the other part.
  [[nodiscard]] bool leadsOn(const Vec3& n_W) const {
    if (!runsAlong(n_W)) return false;
    const EdgeSegment& s = segment(edges[0]);
    const Vec3& end = inModel(n_W).dot(s.to - s.from) < 0 ? s.to : s.from;
    return (end - p_M).norm() > side->shape->models().shell->spacing_m;
  }
  /// True if the point's edge (not a corner) runs towards the other part along this normal: the edge is then
  /// nearer where the edges cross, which is a candidate of its own.
  [[nodiscard]] bool runsAlong(const Vec3& n_W) const {
    if (edges.size() != 1) return false;
    const EdgeSegment& s = segment(edges[0]);
    return std::abs(inModel(n_W).dot((s.to - s.from).normalized())) > kSinLean;
  }
};

/// The nearest point q of a surface to a point p; in W.
struct Foot {
  bool found = false;
  Vec3 from_q = Vec3::Zero();  ///< p - q
  Vec3 normal = Vec3::Zero();  ///< outward at q; at an edge the mean of the normals of its faces
  Vec3 smooth = Vec3::Zero();  ///< normal of the curved surface that the mesh approximates
  bool is_edge = false;
  bool is_sheet = false;             ///< its edges may be wound either way, so that features cover them
  const Surface* surface = nullptr;  ///< null: a primitive
  Mat3 R_WP = Mat3::Identity();      ///< of the surface's part
  std::uint32_t triangle = 0;
  bool is_curved = false;  ///< the triangle stands for a curved surface
};

struct Exact {
  bool found = false;      ///< there is a surface within reach
  bool found_all = false;  ///< every surface of the other side is within reach: a wider search finds the same
  bool is_contact = false;  ///< the surface faces the point
  bool is_inside = false;   ///< the point is behind the nearest surface, or on it
  double distance_m = 0;
  Vec3 n = Vec3::Zero();
  bool is_edge_on_edge = false;
  bool is_smooth = false;                           ///< two faces touch flush
  bool is_own_face = false, is_their_face = false;  ///< whose the plane is
  bool is_curved = false;                           ///< the other's face stands for a curved surface
  FacePoint face;                                   ///< if is_their_face, and no primitive's: the other's
  std::uint16_t surface = 0;                        ///< index of the other's surface
  Vec3 from_q = Vec3::Zero();                       ///< the point minus its foot
};

Foot footOn(const Surface& surface, const Pose& X_WM, const OwnPoint& own, double max_m) {
  const Pose X_WP = X_WM * surface.X_MP;
  const Vec3 p = X_WP.inverse() * own.p_W;
  const MeshDistance::Closest closest = surface.distance->closest(p, max_m);
  if (!closest.found) return {};
  const bool is_edge =
      surface.distance->featureNormal(closest.triangle, 0).dot(closest.normal) < kCosSameFace;
  Foot foot{true,
            X_WP.R * (p - closest.q),
            X_WP.R * closest.normal,
            X_WP.R * surface.distance->smoothNormal(closest.triangle, closest.q),
            is_edge,
            false,
            &surface,
            X_WP.R,
            closest.triangle};
  if (surface.sheet) {
    const SheetFoot seen = surface.sheet->seenFrom(p, X_WP.R.transpose() * own.inward_W, closest);
    foot.normal = X_WP.R * seen.normal;
    if (foot.smooth.dot(foot.normal) < 0) foot.smooth = -foot.smooth;  // seen from behind
    foot.is_sheet = true;
    foot.is_edge |= seen.is_rim;
  }
  return foot;
}

Foot footOn(const btCollisionShape& primitive, const Pose& X_WS, const Vec3& p_W) {
  const SurfaceDistance at = primitiveDistance(primitive, X_WS.inverse() * p_W);
  const Vec3 n = X_WS.R * at.n;
  return {true, at.distance_m * n, n, n, at.is_edge};
}

// Where two smooth areas meet, the contact's normal is that of the curved surface that the facets
// approximate. A facet's normal gives the same gap, but not how the gap changes in sliding: each step would
// end slightly above or below the prediction, and closing these gaps slowed a frictionless nut on its thread
// by 9 % (384 facets a turn).
//
// Elsewhere a point on a face must keep its own tangent plane clear of the other part, so the contact takes
// its own normal. The other's normal would be wrong near edges: the plane of a chamfer, met slightly below
// the chamfer's rim, would stop a peg that slides past. A point on an edge has no tangent plane, so it takes
// the normal of the other's face.
Exact contactAt(const Foot& foot, const OwnPoint& own) {
  Exact exact;
  exact.found = exact.found_all = foot.found;
  exact.from_q = foot.from_q;
  if (!foot.found) return exact;
  exact.is_inside = foot.from_q.dot(foot.normal) < kSamePlace_m && !foot.is_sheet;
  const double cos_facing = own.inward_W.dot(foot.normal);
  const bool is_edge_on_edge = own.is_edge && foot.is_edge;
  const bool is_facing = cos_facing > kSinGrazing;
  exact.is_contact = own.edges.empty() || is_edge_on_edge
                         ? is_facing
                         : own.isFirstAlong(foot.normal) || (is_facing && !own.is_two_sided);
  // Where the point's edge leads on towards the face, a later one of its points or its crossing with the
  // face's border is nearer. A curved surface has no border between its facets, and may bend towards the
  // edge.
  if (own.is_edge && !foot.is_edge && !foot.is_sheet && !foot.is_curved && own.leadsOn(foot.normal))
    exact.is_contact = false;
  exact.is_curved = foot.is_curved;
  if (exact.is_contact && !is_edge_on_edge) {
    const bool is_flush = !foot.is_edge && cos_facing > kCosSameFace;
    exact.is_smooth = is_flush && !own.is_edge;
    exact.is_their_face = own.is_edge || is_flush;
    exact.is_own_face = !exact.is_their_face;
    exact.n = exact.is_their_face ? foot.smooth : own.inward_W;
    exact.distance_m = foot.from_q.dot(exact.n);
    if (exact.is_their_face && foot.surface)
      exact.face = {own.p_W - foot.from_q, foot.smooth, foot.surface, foot.R_WP, foot.triangle};
    return exact;
  }
  const double sign = foot.from_q.dot(foot.normal) < 0 ? -1 : 1;
  const double distance_m = foot.from_q.norm();
  exact.distance_m = sign * distance_m;
  exact.n = distance_m > kSamePlace_m ? Vec3(sign / distance_m * foot.from_q) : foot.normal;
  exact.is_edge_on_edge = is_edge_on_edge;
  if (is_edge_on_edge && own.runsAlong(exact.n)) exact.is_contact = false;
  return exact;
}

/// Exact contact of one shell point with all surfaces of the other side.
struct Refiner {
  const SideView& side;
  const SideView& other;
  const btCollisionShape& theirs;
  bool is_primitive;

  Exact at(const OwnPoint& own, double max_m) const {
    if (is_primitive) return contactAt(footOn(theirs, other.X_WM, own.p_W), own);
    // A cooked body is the union of its parts: the least of their signed distances.
    Exact nearest;
    bool found_all = true;
    const std::vector<Surface>& surfaces = other.shape->models().surfaces;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      Foot foot = footOn(surfaces[i], other.X_WM, own, max_m);
      foot.is_curved = foot.found && other.shape->features().isCurved(i, foot.triangle);
      Exact exact = contactAt(foot, own);
      exact.surface = static_cast<std::uint16_t>(i);
      found_all &= exact.found;
      nearest.found |= exact.found;
      nearest.is_inside |= exact.is_inside;
      if (exact.is_contact && (!nearest.is_contact || exact.distance_m < nearest.distance_m)) nearest = exact;
    }
    nearest.found_all = found_all;
    return nearest;
  }
};

// A point that is inside near an edge of the other side, and is not first along the nearest face there: a
// corner that slides down a wall, a micrometre inside, to the wall's lower rim. The face that it entered
// through is one of the others at that edge. Or a point on it: where edges lie flush, rounding decides on
// which side, and the next face would be half a millimetre deep.
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
      // An edge that runs through the face's plane goes on behind it.
      if (!own.isFirstAlong(X_WM.R * n) || own.runsAlong(X_WM.R * n)) continue;
      best.found = best.is_contact = best.is_their_face = true;
      best.distance_m = distance_m;
      best.n = X_WM.R * n;
      best.surface = s.owner;
    }
  });
  return best;
}

// True if a point beside an edge passes that edge no lower than the rest gap below the plane that it meets at
// the end of the step: it slides onto the face, and sinks into it only if nothing holds it there.
bool slidesOnto(const Exact& end, const Exact& now, const Vec3& way_W) {
  const double height_m = end.distance_m - end.n.dot(way_W);
  const Vec3 beside = now.from_q - now.from_q.dot(end.n) * end.n;
  const double nearer_m2 = -way_W.dot(beside);
  if (height_m < -FeatureMotion::kRest_m || !(nearer_m2 > 0)) return false;
  const double share = std::min(beside.squaredNorm() / nearer_m2, 1.0);
  return height_m + share * end.n.dot(way_W) >= -FeatureMotion::kRest_m;
}

// The line between two edges turns fast as they pass each other, and would stop a point that is about to pass
// without contact. So the surface that the point meets at the end of the step counts, unless that is an
// overlap. Its plane may lie beyond where the point is now, by as much as the bodies would move if nothing
// stopped them. It must not push: no contact is deeper than it is now.
Exact atEndOfStep(const Exact& now, const Refiner& refiner, const OwnPoint& own, const Vec3& way_W,
                  double max_m) {
  Exact end = refiner.at(own.movedTo(own.p_W + way_W), max_m + way_W.norm());
  if (end.found && !(end.is_contact && (end.distance_m >= 0 || slidesOnto(end, now, way_W)))) return now;
  end.distance_m = std::max(end.distance_m - end.n.dot(way_W), std::min(0.0, now.distance_m));
  return end;
}

// How the faces around a contact curve: see Candidate.
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
    // Outside an edge the field may read less than half of the distance, along a normal of its own: such a
    // plane would stop or lift a body that does not come near the point.
    if (!exact.found)
      if (Candidate by_field = c; motion.canTouch(by_field))
        exact = refiner.at(own, max_m + motion.dt_s * motion.velocityAt(c.p_W).norm());
    if (!exact.found) continue;  // only the field is known
    if (!exact.is_contact && exact.is_inside && !own.edges.empty())
      if (const Exact beside = besideEdge(refiner, own, max_m); beside.found) exact = beside;
    if (exact.is_contact && exact.is_edge_on_edge)
      exact = atEndOfStep(exact, refiner, own, sign * motion.dt_s * motion.velocityAt(c.p_W), max_m);
    c.distance_m = exact.is_contact ? exact.distance_m : kNever_m;
    c.n_W = sign * exact.n;
    if (exact.is_contact) c.surface[1 - c.side] = exact.surface;
    c.is_flush = exact.is_curved && own.isFlushOn(exact.n);
    c.plane_of = exact.is_own_face     ? side.side
                 : exact.is_their_face ? static_cast<std::uint8_t>(1 - side.side)
                                       : Candidate::kBetween;
    setCurvature(c, exact, side);
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
    c.distance_m = exact.is_contact ? exact.distance_m : kNever_m;
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

}  // namespace vps::bullet::inline v0
