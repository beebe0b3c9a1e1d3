// SPDX-License-Identifier: BSD-3-Clause
#include "query/features/feature_contact.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vps/contact_tolerances.h"

namespace vps {

using Kind = FeatureContact::Kind;

namespace {

// The corner of a facet that another facet does not have.
Vec3 apexOf(const FeatureSet& part, std::uint32_t facet, std::uint32_t other) {
  const auto &t = part.facets()[facet], &u = part.facets()[other];
  const auto* apex = std::find_if(
      t.begin(), t.end() - 1, [&](std::uint32_t v) { return std::find(u.begin(), u.end(), v) == u.end(); });
  return part.vertices()[*apex];
}

// True if a facet's nearest point p lies on its border and a neighbouring facet is nearer; the neighbour's
// own contact then counts. A nut's corner that slides on a flank passes below the crest's facets, which end
// there, and does not touch them.
bool isNeighbourNearer(const FeatureSet& part, std::uint32_t facet, const Vec3& p, const Vec3& n) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t other = part.neighbours(facet)[k];
    if (other == FeatureSet::kNone || distanceToSide(part, facet, k, p) > kRounding_m) continue;
    const Vec3 into = apexOf(part, other, facet) - p;
    if (n.dot(into) > kSinLean * into.norm()) return true;
  }
  return false;
}

// True if the feature is touched from outside: a facet from its front, an edge from between its facets. Other
// pairs are nearest through the solid, behind a feature that is touched first.
// @param p  the nearest point, in the part's frame
bool isMetFromOutside(const FeatureSet& part, Kind kind, int i, std::uint32_t feature, const Vec3& p,
                      const Vec3& n) {
  const double sign = i == 1 ? 1 : -1;  // n points out of part 1 and into part 0
  if (kind == Kind::EdgeOnEdge) {
    const FeatureEdge& edge = part.edges()[feature];
    return !edge.has_faces ||
           (sign * n.dot(edge.into[0]) <= kSinLean && sign * n.dot(edge.into[1]) <= kSinLean);
  }
  if ((kind == Kind::CornerOnFacet) == (i == 0) || part.isTwoSided(feature)) return true;
  return sign * n.dot(part.normal(feature)) > 0 && !isNeighbourNearer(part, feature, p, sign * n);
}

}  // namespace

Vec3 FeatureContact::normal_0(const Pose& X_01) const {
  const Vec3 fixed = plane_of == 0 ? n : Vec3(X_01.R * n);
  if (kind != Kind::EdgeOnEdge) return fixed;
  const Vec3 across = along[0].cross(X_01.R * along[1]);
  if (!(across.norm() > kSinParallel)) return fixed;
  return (across.dot(fixed) < 0 ? -1 : 1) * across.normalized();
}

double FeatureContact::gap_m(const Pose& X_01) const {
  return normal_0(X_01).dot(p[0] - X_01 * p[1]);
}

namespace {

// Maps point p of a moved feature of part 0 to the part's own frame, by its weights among the feature's
// vertices.
Vec3 inOwnFrame(Kind kind, const Vec3 (&own)[3], const Vec3 (&at)[3], const Vec3& p) {
  if (kind == Kind::CornerOnFacet) return own[0];
  if (kind == Kind::EdgeOnEdge) {
    const Vec3 way = at[1] - at[0];
    return own[0] + (p - at[0]).dot(way) / way.squaredNorm() * (own[1] - own[0]);
  }
  const Vec3 u = at[1] - at[0], v = at[2] - at[0], r = p - at[0];
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), det = uu * vv - uv * uv;
  const double s = (vv * r.dot(u) - uv * r.dot(v)) / det, t = (uu * r.dot(v) - uv * r.dot(u)) / det;
  return own[0] + s * (own[1] - own[0]) + t * (own[2] - own[0]);
}

// A contact of features whose points and plane are not set yet.
FeatureContact contactOf(Kind kind, const std::uint32_t (&feature)[2], const Features& f) {
  FeatureContact contact;
  contact.kind = kind;
  contact.plane_of = kind == Kind::FacetOnCorner ? 0 : 1;
  for (int i = 0; i < 2; ++i) contact.feature[i] = feature[i];
  if (kind == Kind::EdgeOnEdge) {
    contact.along[0] = (f.own[1] - f.own[0]).normalized();
    contact.along[1] = (f.b[1] - f.b[0]).normalized();
  }
  return contact;
}

// A contact whose points are those of features that were moved by a share of their displacement.
FeatureContact contactAt(Kind kind, const std::uint32_t (&feature)[2], const Features& f,
                         const Approach& reach) {
  FeatureContact contact = contactOf(kind, feature, f);
  Vec3 at[3];
  f.moveTo(reach.share, at);
  contact.p[0] = inOwnFrame(kind, f.own, at, reach.nearest.p);
  contact.p[1] = reach.nearest.q;
  return contact;
}

// Decides which feature has the contact, for features that come within the rest gap after a share of their
// displacement.
BorderOwner ownerOf(const FeatureSet& part0, const FeatureSet& part1, const FeatureContact& contact,
                    const Features& f, const Approach& reach, const Mat3& R_10) {
  const auto [p, q] = std::pair(reach.nearest.p, reach.nearest.q);
  if (contact.kind == Kind::EdgeOnEdge || !((p - q).norm() < FeatureMotion::kRest_m))
    return BorderOwner::Edge;
  Vec3 at[3];
  f.moveTo(reach.share, at);
  const Vec3 way = inOwnFrame(contact.kind, f.way, at, p);
  constexpr double kTolerated_m = FeatureMotion::kLeastShare * FeatureMotion::kRest_m;
  if (contact.kind == Kind::CornerOnFacet) {
    const PassingCorner corner{p - q, way, part0.raysAt(contact.feature[0]), R_10};
    return ownerAtBorder(part1, contact.feature[1], q, corner, kTolerated_m);
  }
  const Mat3 R_01 = R_10.transpose();
  const PassingCorner corner{R_01 * (q - p), -(R_01 * way), part1.raysAt(contact.feature[1]), R_01};
  return ownerAtBorder(part0, contact.feature[0], contact.p[0], corner, kTolerated_m);
}

// True if two edges are nearest at a corner that has a contact of its own. A corner in a valley has no
// contact: inside a ring, at the joint of two of its sections, an edge of another ring slides from one
// section to the next.
// @param n_1, n_0  from part 1 to part 0, in each part's frame
bool isLeftToCorner(const FeatureSet& part0, const FeatureSet& part1, const std::uint32_t (&feature)[2],
                    const Nearest& nearest, const Vec3& n_0, const Vec3& n_1) {
  const auto isOutermost = [&](const FeatureSet& part, int i, const Vec3& n) {
    if (nearest.end[i] == Nearest::kBetween) return false;
    const FeatureEdge& edge = part.edges()[feature[i]];
    return part.isOutermostAt(nearest.end[i] == 0 ? edge.from : edge.to, n);
  };
  return isOutermost(part0, 0, -n_0) || isOutermost(part1, 1, n_1);
}

// Two features that do not move, part 0 at X_10.
Features featuresAt(const FeatureSet& part0, const FeatureSet& part1, Kind kind,
                    const std::uint32_t (&feature)[2], const Pose& X_10) {
  Features f;
  f.load(part0, part1, kind, feature);
  f.moveFrom(X_10, X_10);
  return f;
}

}  // namespace

bool findContact(const FeatureSet& part0, const FeatureSet& part1, Kind kind,
                 const std::uint32_t (&feature)[2], const Features& f, const Approach& reach,
                 const Mat3& R_10, FeatureContact& contact) {
  const Nearest& nearest = reach.nearest;
  contact = contactAt(kind, feature, f, reach);
  Vec3 n_1 = (nearest.p - nearest.q).normalized(), n_0 = R_10.transpose() * n_1;
  if (kind == Kind::EdgeOnEdge && isLeftToCorner(part0, part1, feature, nearest, n_0, n_1)) return false;
  const BorderOwner owner = ownerOf(part0, part1, contact, f, reach, R_10);
  if (owner == BorderOwner::Neighbour) return false;
  if (owner == BorderOwner::Facet) {
    n_1 = contact.plane_of == 1 ? part1.normal(feature[1]) : Vec3(-(R_10 * part0.normal(feature[0])));
    n_0 = contact.plane_of == 1 ? Vec3(R_10.transpose() * n_1) : Vec3(-part0.normal(feature[0]));
  }
  contact.n = contact.plane_of == 0 ? n_0 : n_1;
  return isMetFromOutside(part0, kind, 0, feature[0], contact.p[0], n_0) &&
         isMetFromOutside(part1, kind, 1, feature[1], contact.p[1], n_1) &&
         !isLeftToPoints(part0, part1, contact, R_10, n_1);
}

bool findCrossing(const FeatureSet& part0, const FeatureSet& part1, const std::uint32_t (&feature)[2],
                  const Features& f, const Pose& end_10, const Vec3& n_1, FeatureContact& contact) {
  const Vec3 a = end_10 * f.own[0], way_a = end_10.R * (f.own[1] - f.own[0]);
  const Vec3 &b = f.b[0], way_b = f.b[1] - f.b[0], across = way_a.cross(way_b);
  if (!(across.norm() > kSinParallel * way_a.norm() * way_b.norm())) return false;
  const double share_a = (b - a).cross(way_b).dot(across) / across.squaredNorm(),
               share_b = (b - a).cross(way_a).dot(across) / across.squaredNorm();
  if (!(share_a > 0 && share_a < 1 && share_b > 0 && share_b < 1)) return false;
  contact = contactOf(Kind::EdgeOnEdge, feature, f);
  contact.p[0] = f.own[0] + share_a * (f.own[1] - f.own[0]);
  contact.p[1] = b + share_b * way_b;
  contact.n = (across.dot(n_1) < 0 ? -1 : 1) * across.normalized();
  const auto areMetFromOutside = [&] {
    const Vec3 n_0 = end_10.R.transpose() * contact.n;
    return isMetFromOutside(part0, Kind::EdgeOnEdge, 0, feature[0], contact.p[0], n_0) &&
           isMetFromOutside(part1, Kind::EdgeOnEdge, 1, feature[1], contact.p[1], contact.n);
  };
  // Near an end of an edge, the direction to this end does not tell on which side of the other edge it is.
  if (!areMetFromOutside()) contact.n = -contact.n;
  return contact.n.dot(end_10 * contact.p[0] - contact.p[1]) < 0 && areMetFromOutside() &&
         !isLeftToPoints(part0, part1, contact, end_10.R, contact.n);
}

double distanceAt(const FeatureSet& part0, const FeatureSet& part1, const FeatureContact& contact,
                  const Pose& X_01) {
  const Features f = featuresAt(part0, part1, contact.kind, contact.feature, X_01.inverse());
  return nearestOf(contact.kind, f.a, f.b).distance_m();
}

bool measureAgain(const FeatureSet& part0, const FeatureSet& part1, const Pose& X_01, double most_m,
                  FeatureContact& contact) {
  const Pose X_10 = X_01.inverse();
  const FeatureContact last = contact;
  const Features f = featuresAt(part0, part1, last.kind, last.feature, X_10);
  const Approach reach = {0, nearestOf(last.kind, f.a, f.b)};
  const double distance_m = reach.nearest.distance_m();
  if (!(distance_m > kRounding_m && distance_m < most_m)) return false;
  if (!findContact(part0, part1, last.kind, last.feature, f, reach, X_10.R, contact)) return false;
  contact.start_m = distance_m;
  return true;
}

}  // namespace vps
