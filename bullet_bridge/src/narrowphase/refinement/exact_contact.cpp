// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/refinement/exact_contact.h"

#include <algorithm>
#include <cmath>

#include "native_shapes/native_shape.h"
#include "native_shapes/native_shape_adapter.h"
#include "shape/sheet_border.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet {

bool OwnPoint::isFlushOn(const Vec3& n_W) const {
  const Vec3 n = inModel(n_W);
  for (const std::uint32_t i : edges)
    if (n.dot(segment(i).normal(0)) < -kCosSameFace || n.dot(segment(i).normal(1)) < -kCosSameFace)
      return true;
  return false;
}

bool OwnPoint::isFirstAlong(const Vec3& n_W) const {
  const Vec3 n = inModel(n_W);
  // Around a corner the part lies within the cone of the corner's edges. The corner may be the lowest point
  // although a face falls off across one of the edges, as on a slanted tetrahedron.
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

bool OwnPoint::leadsOn(const Vec3& n_W) const {
  if (!runsAlong(n_W)) return false;
  const EdgeSegment& s = segment(edges[0]);
  const Vec3& end = inModel(n_W).dot(s.to - s.from) < 0 ? s.to : s.from;
  return (end - p_M).norm() > side->shape->models().shell->spacing_m;
}

bool OwnPoint::runsAlong(const Vec3& n_W) const {
  if (edges.size() != 1) return false;
  const EdgeSegment& s = segment(edges[0]);
  return std::abs(inModel(n_W).dot((s.to - s.from).normalized())) > kSinLean;
}

namespace {

/// The nearest point q of a surface to a point p; in W.
struct Foot {
  bool found = false;
  Vec3 from_q = Vec3::Zero();  ///< p - q
  Vec3 normal = Vec3::Zero();  ///< outward at q; at an edge the mean of the adjacent faces' normals
  Vec3 smooth = Vec3::Zero();  ///< normal of the curved surface that the mesh approximates
  bool is_edge = false;
  bool is_sheet = false;             ///< a sheet's edges may be wound either way; FeatureSet covers them
  const Surface* surface = nullptr;  ///< null: a primitive
  Mat3 R_WP = Mat3::Identity();      ///< orientation of the surface's part
  std::uint32_t triangle = 0;
  bool is_curved = false;  ///< the triangle approximates a curved surface
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

// Where two smooth areas meet, the contact takes the normal of the curved surface that the facets
// approximate. A facet's normal gives the same gap but not the change of the gap in sliding: each step would
// end slightly above or below the prediction. Closing the gaps of facets slowed a frictionless nut on its
// thread by 9 % (384 facets a turn).
//
// Elsewhere a point on a face must keep its own tangent plane clear of the other part, so the contact takes
// its own normal. The normal of the other part would be wrong near edges: the plane of a chamfer, met
// slightly below the chamfer's rim, would stop a peg that slides past. A point on an edge has no tangent
// plane, so it takes the normal of the other part's face.
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
  // Where the point's edge continues towards the face, a point farther along the edge, or its crossing with
  // the face's border, is nearer. A curved surface has no border between its facets and may bend towards the
  // edge, so it is excepted.
  if (own.is_edge && !foot.is_edge && !foot.is_sheet && !foot.is_curved && own.leadsOn(foot.normal))
    exact.is_contact = false;
  exact.is_curved = foot.is_curved;
  exact.is_on_edge = foot.is_edge;
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

}  // namespace

Exact Refiner::at(const OwnPoint& own, double max_m) const {
  if (is_primitive) return contactAt(footOn(theirs, other.X_WM, own.p_W), own);
  // The signed distance of a merged body, which is the union of its parts, is the least of theirs.
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

}  // namespace vps::bullet
