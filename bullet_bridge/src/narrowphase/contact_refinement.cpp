// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <span>

#include "narrowphase/contact_candidate.h"
#include "narrowphase/curved_contact.h"
#include "narrowphase/round_contact.h"
#include "native_shapes/native_shape_adapter.h"
#include "native_shapes/primitive.h"

namespace vps::bullet {

namespace {

// A face's point and a surface that looks away from it do not meet, however near they are: such as a table's
// top and the side of a box that stands on it. 0.2: about 78 degrees, so that a corner's mean normal still
// meets each face.
constexpr double kFacing = 0.2;
constexpr double kCosEdge = 0.94;     // 20 degrees, as in PointShellSettings::edge_angle_rad
constexpr double kAlong = 0.087;      // 5 degrees, as findCrossings()
constexpr double kInto = 0.17;        // 10 degrees. assumed: beyond the facets of what are flush round faces
constexpr double kNever_m = 1;        // far beyond any step
constexpr double kTouching_m = 1e-6;  // below this, p - q is too short to be trusted as a direction

/// A shell point and what its own part is like around it.
struct OwnPoint {
  Vec3 p_W, inward_W;
  bool is_edge = false;
  const SideView* side = nullptr;             ///< null: edges are not asked for
  std::span<const std::uint32_t> edges = {};  ///< of side, that the point stands on
  Vec3 p_M = Vec3::Zero();                    ///< the point in its models' frame
  bool is_answered = true;                    ///< the other part's points are looked at too

  OwnPoint movedTo(const Vec3& place_W) const {
    OwnPoint moved = *this;
    moved.p_W = place_W;
    return moved;
  }
  [[nodiscard]] const EdgeSegment& segment(std::uint32_t i) const {
    return side->shape->edges().segments()[i];
  }
  [[nodiscard]] Vec3 inModel(const Vec3& n_W) const { return side->X_WM.R.transpose() * n_W; }
  /// True if the part lies, around the point, on the far side of a plane with this normal through it. If not,
  /// another point is what meets the plane, and deeper; or where the other part ends before, its edge is what
  /// meets this part's face.
  [[nodiscard]] bool isFirstAlong(const Vec3& n_W) const {
    const Vec3 n = inModel(n_W);
    for (const std::uint32_t i : edges) {
      const EdgeSegment& s = segment(i);
      if (std::min(n.dot(s.into[0]), n.dot(s.into[1])) < -kInto) return false;
      const Vec3 along = (s.to - s.from).normalized();
      if ((p_M - s.from).norm() < kTouching_m && n.dot(along) < -kInto) return false;
      if ((p_M - s.to).norm() < kTouching_m && n.dot(along) > kInto) return false;
    }
    return true;
  }
  /// True if its edge, no corner, runs towards the other along this normal: then it is nearer elsewhere,
  /// where they cross, which is a candidate of its own.
  [[nodiscard]] bool runsAlong(const Vec3& n_W) const {
    if (edges.size() != 1) return false;
    const EdgeSegment& s = segment(edges[0]);
    return std::abs(inModel(n_W).dot((s.to - s.from).normalized())) > kAlong;
  }
};

/// The nearest point q of a surface to a point p; in W.
struct Foot {
  bool found = false;
  Vec3 from_q = Vec3::Zero();  ///< p - q
  Vec3 normal = Vec3::Zero();  ///< outward at q; at an edge the mean of its faces'
  Vec3 smooth = Vec3::Zero();  ///< the normal of the curved surface that the mesh stands for
  bool is_edge = false;
  bool is_sheet = false;             ///< whose edges may be wound either way: crossings do not cover them
  const Surface* surface = nullptr;  ///< null: a primitive
  Mat3 R_WP = Mat3::Identity();      ///< of the surface's part
  std::uint32_t triangle = 0;
};

struct Exact {
  bool found = false;  ///< there is a surface within reach
  bool meets = false;  ///< and it faces the point
  double distance_m = 0;
  Vec3 n = Vec3::Zero();
  bool is_edge_on_edge = false;
  bool is_smooth = false;  ///< two faces that touch flush
  FacePoint face;          ///< then: the other's
};

Foot footOn(const Surface& surface, const Pose& X_WM, const OwnPoint& own, double max_m) {
  const Pose X_WP = X_WM * surface.X_MP;
  const Vec3 p = X_WP.inverse() * own.p_W;
  const MeshDistance::Closest closest = surface.distance->closest(p, max_m);
  if (!closest.found) return {};
  const bool is_edge = surface.distance->featureNormal(closest.triangle, 0).dot(closest.normal) < kCosEdge;
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
    if (foot.smooth.dot(foot.normal) < 0) foot.smooth = -foot.smooth;  // from behind
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

// Where two smooth stretches of surface meet, the contact's normal is that of the curved surface behind the
// facets. A facet's own tells where they touch as well, but not how the gap will change as they slide: each
// step then ends a little above or below what was foreseen, and closing such gaps braked a frictionless nut
// on its thread by 9 % (384 facets a turn).
//
// Elsewhere a point on a face must keep its own tangent plane clear of the other part, so its own normal is
// the contact's. The other's would be wrong near its edges: the plane of a chamfer, met a hair below the
// chamfer's rim, would stop a peg that slides past. A point on an edge has no tangent plane; the other's face
// has.
Exact contactAt(const Foot& foot, const OwnPoint& own) {
  Exact exact;
  exact.found = foot.found;
  if (!foot.found) return exact;
  const double cos_facing = own.inward_W.dot(foot.normal);
  const bool is_edge_on_edge = own.is_edge && foot.is_edge;
  const bool is_facing = cos_facing > kFacing;
  exact.meets = own.edges.empty() || is_edge_on_edge
                    ? is_facing
                    : own.isFirstAlong(foot.normal) || (is_facing && !own.is_answered);
  if (exact.meets && !is_edge_on_edge) {
    const bool is_flush = !foot.is_edge && cos_facing > kCosFlush;
    exact.is_smooth = is_flush && !own.is_edge;
    exact.n = own.is_edge || is_flush ? foot.smooth : own.inward_W;
    exact.distance_m = foot.from_q.dot(exact.n);
    if (exact.is_smooth)
      exact.face = {own.p_W - foot.from_q, foot.smooth, foot.surface, foot.R_WP, foot.triangle};
    return exact;
  }
  const double sign = foot.from_q.dot(foot.normal) < 0 ? -1 : 1;
  const double distance_m = foot.from_q.norm();
  exact.distance_m = sign * distance_m;
  exact.n = distance_m > kTouching_m ? Vec3(sign / distance_m * foot.from_q) : foot.normal;
  exact.is_edge_on_edge = is_edge_on_edge;
  if (is_edge_on_edge && !foot.is_sheet && own.runsAlong(exact.n)) exact.meets = false;
  return exact;
}

/// Exact contact of one shell point with all of the other side.
struct Corrector {
  const SideView& side;
  const SideView& other;
  const btCollisionShape& theirs;
  bool is_primitive;

  Exact at(const OwnPoint& own, double max_m) const {
    if (is_primitive) return contactAt(footOn(theirs, other.X_WM, own.p_W), own);
    // A cooked body is the union of its parts: the least of their signed distances.
    Exact nearest;
    for (const Surface& surface : other.shape->models().surfaces) {
      const Exact exact = contactAt(footOn(surface, other.X_WM, own, max_m), own);
      nearest.found |= exact.found;
      if (exact.meets && (!nearest.meets || exact.distance_m < nearest.distance_m)) nearest = exact;
    }
    return nearest;
  }
};

// The line between two edges turns fast as they pass each other, and would stop a point that is about to pass
// clear. What the point meets at the end of its way counts, as long as that is not an overlap.
Exact whereItGoes(const Exact& now, const Corrector& corrector, const OwnPoint& own, const Vec3& way_W,
                  double max_m) {
  Exact end = corrector.at(own.movedTo(own.p_W + way_W), max_m + way_W.norm());
  if (end.found && !(end.meets && end.distance_m >= 0)) return now;
  end.distance_m -= end.n.dot(way_W);
  return end;
}

}  // namespace

void correct(std::vector<Candidate>& candidates, const SideView& side, const SideView& other,
             const btCollisionShape& theirs, const RelativeMotion& motion, bool is_answered) {
  const bool is_primitive = isPrimitive(theirs);
  if (!is_primitive && other.shape->models().surfaces.empty()) return;
  const Corrector corrector{side, other, withoutStandIn(theirs), is_primitive};
  const PointShell& shell = *side.shape->models().shell;
  const double sign = side.side == 0 ? 1 : -1;
  // The field is off by less than a voxel; beyond that it is not the same piece of surface.
  const double field_error_m =
      other.shape && other.shape->models().map ? other.shape->models().map->voxel_m() : kTouching_m;
  for (Candidate& c : candidates) {
    if (c.side != side.side || c.isCrossing()) continue;
    if (is_primitive && touchRound(c, side, other, corrector.theirs)) continue;
    const OwnPoint own{c.p_W,
                       side.X_WM.R * shell.inward[c.id],
                       side.shape->isEdgePoint(c.id),
                       &side,
                       is_primitive ? std::span<const std::uint32_t>() : side.shape->edgesAt(c.id),
                       shell.points[c.id],
                       is_answered};
    const double max_m = std::abs(c.distance_m) + field_error_m;
    Exact exact = corrector.at(own, max_m);
    if (!exact.found) continue;  // the field is all there is
    if (exact.meets && exact.is_edge_on_edge)
      exact = whereItGoes(exact, corrector, own, sign * motion.dt_s * motion.velocityAt(c.p_W), max_m);
    c.distance_m = exact.meets ? exact.distance_m : kNever_m;
    c.n_W = sign * exact.n;
    if (exact.meets && exact.is_smooth && !is_primitive)
      moveToNearest(c, side, other, exact.face, motion.contact_margin_m);
  }
}

namespace {

// The search for the nearest triangle costs by how far it has to look. Most fields are good to a small part
// of a voxel, but at sharp edges.
Exact nearFieldDistance(const Corrector& corrector, const Vec3& p_W, const Vec3& inward, double field_m,
                        double voxel_m) {
  const OwnPoint own{p_W, inward, true};  // springs know no crossings: the points of edges are all they have
  constexpr double kMostly = 0.05, kAlways = 1;  // of a voxel
  Exact exact = corrector.at(own, std::abs(field_m) + kMostly * voxel_m);
  if (!exact.found) exact = corrector.at(own, std::abs(field_m) + kAlways * voxel_m);
  return exact;
}

}  // namespace

void correctEdges(std::vector<Candidate>& candidates, const SideView& side, const SideView& other,
                  const btCollisionShape& theirs, const Pose (&way)[2], const RelativeMotion& motion) {
  if (isPrimitive(theirs) || !other.shape->models().map || other.shape->models().surfaces.empty()) return;
  const VoxMap& map = *other.shape->models().map;
  const PointShell& shell = *side.shape->models().shell;
  const double sign = side.side == 0 ? 1 : -1;
  const int i = side.side, j = 1 - i;
  const SideView other_then{other.shape, way[j] * other.X_WM, other.side};
  const Pose X_MW = other_then.X_WM.inverse();
  constexpr double kFieldError = 0.3;  // of a voxel: beyond it a point does not touch
  const Corrector now{side, other, theirs, false}, then{side, other_then, theirs, false};
  for (Candidate& c : candidates) {
    if (c.side != side.side || !side.shape->isEdgePoint(c.id)) continue;
    const Vec3 inward = side.X_WM.R * shell.inward[c.id], p_then_W = way[i] * c.p_W;
    const double field_m = map.distance(X_MW * p_then_W);
    if (field_m > kFieldError * map.voxel_m()) continue;
    Exact exact = nearFieldDistance(then, p_then_W, way[i].R * inward, field_m, map.voxel_m());
    if (exact.found && exact.meets &&
        exact.distance_m >= std::min(0.0, c.distance_m) - motion.contact_margin_m) {
      exact.distance_m -= exact.n.dot((p_then_W - c.p_W) - (way[j] * c.p_W - c.p_W));
    } else {
      exact = nearFieldDistance(now, c.p_W, inward, c.distance_m, map.voxel_m());
      if (!exact.found) continue;
    }
    c.distance_m = exact.meets ? exact.distance_m : kNever_m;
    c.n_W = sign * exact.n;
  }
}

void takeOwnNormals(std::vector<Candidate>& candidates, const SideView& side) {
  const double sign = side.side == 0 ? 1 : -1;
  std::erase_if(candidates, [&](Candidate& c) {
    if (c.side != side.side || side.shape->isEdgePoint(c.id)) return false;
    const Vec3 own = sign * (side.X_WM.R * side.shape->smoothInward(c.id));
    const double facing = own.dot(c.n_W);
    if (facing <= kFacing) return true;
    c.distance_m *= facing;  // of the nearest point's tangent plane
    c.n_W = own;
    return false;
  });
}

}  // namespace vps::bullet
