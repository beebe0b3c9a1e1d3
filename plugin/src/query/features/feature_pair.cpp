// SPDX-License-Identifier: BSD-3-Clause
#include "query/features/feature_pair.h"

#include <algorithm>

#include "mesh/triangle_distance.h"
#include "vps/contact_tolerances.h"

namespace vps {

Nearest nearestPointsOfSegments(const Vec3& p1, const Vec3& q1, const Vec3& p2, const Vec3& q2) {
  const Vec3 d1 = q1 - p1, d2 = q2 - p2, r = p1 - p2;
  const double a = d1.squaredNorm(), e = d2.squaredNorm(), f = d2.dot(r), c = d1.dot(r), b = d1.dot(d2);
  const double square = a * e - b * b;
  double s =
      square > kNoDirection * kNoDirection * a * e ? std::clamp((b * f - c * e) / square, 0.0, 1.0) : 0.0;
  double t = (b * s + f) / e;
  if (t < 0) {
    t = 0;
    s = std::clamp(-c / a, 0.0, 1.0);
  } else if (t > 1) {
    t = 1;
    s = std::clamp((b - c) / a, 0.0, 1.0);
  }
  const auto endAt = [](double share) {
    return share <= 0 ? std::int8_t{0} : share >= 1 ? std::int8_t{1} : Nearest::kBetween;
  };
  return {p1 + s * d1, p2 + t * d2, {endAt(s), endAt(t)}};
}

using Kind = FeatureContact::Kind;

Nearest nearestOf(Kind kind, const Vec3 (&a)[3], const Vec3 (&b)[3]) {
  if (kind == Kind::CornerOnFacet) return {a[0], closestOnTriangleInline(a[0], b[0], b[1], b[2]).q};
  if (kind == Kind::FacetOnCorner) return {closestOnTriangleInline(b[0], a[0], a[1], a[2]).q, b[0]};
  return nearestPointsOfSegments(a[0], a[1], b[0], b[1]);
}

int pointsOf(const FeatureSet& part, Kind kind, int i, std::uint32_t feature, Vec3 (&out)[3]) {
  const std::vector<Vec3>& v = part.vertices();
  if (kind == Kind::EdgeOnEdge) {
    const FeatureEdge& edge = part.edges()[feature];
    out[0] = v[edge.from];
    out[1] = v[edge.to];
    return 2;
  }
  if ((kind == Kind::CornerOnFacet) == (i == 0)) {
    out[0] = v[part.corners()[feature]];
    return 1;
  }
  for (std::size_t k = 0; k < 3; ++k) out[k] = v[part.facets()[feature][k]];
  return 3;
}

namespace {

// The share of the step up to which the slab between both features along n stays wider than least_m.
double slabShare(const Features& f, const Vec3& n, double least_m) {
  double top = n.dot(f.b[0]);
  for (int i = 1; i < f.b_count; ++i) top = std::max(top, n.dot(f.b[i]));
  double share = 2;
  for (int i = 0; i < f.a_count; ++i) {
    const double speed = n.dot(f.way[i]);
    if (speed < 0) share = std::min(share, (top + least_m - n.dot(f.a[i])) / speed);
  }
  return share;
}

/// A vector that changes linearly between two shares.
struct Linear {
  Vec3 from, to;
};

// Two vectors A and B whose product is normal to both edges, or to the facet, and a vector r between the
// features.
void vectorsOf(Kind kind, const Features& f, double from, double to, Linear& A, Linear& B, Linear& r) {
  Vec3 at[2][3];
  f.moveTo(from, at[0]);
  f.moveTo(to, at[1]);
  const auto of = [&](Linear& out, const auto& get) { out = {get(at[0]), get(at[1])}; };
  using Points = Vec3[3];
  if (kind == Kind::EdgeOnEdge) {
    of(A, [](const Points& a) { return Vec3(a[1] - a[0]); });
    B = {f.b[1] - f.b[0], f.b[1] - f.b[0]};
    of(r, [&](const Points& a) { return Vec3(a[0] - f.b[0]); });
  } else if (kind == Kind::CornerOnFacet) {
    A = {f.b[1] - f.b[0], f.b[1] - f.b[0]};
    B = {f.b[2] - f.b[0], f.b[2] - f.b[0]};
    of(r, [&](const Points& a) { return Vec3(a[0] - f.b[0]); });
  } else {
    of(A, [](const Points& a) { return Vec3(a[1] - a[0]); });
    of(B, [](const Points& a) { return Vec3(a[2] - a[0]); });
    of(r, [&](const Points& a) { return Vec3(f.b[0] - a[0]); });
  }
}

// True if the lines of both edges, or the corner and the facet's plane, stay farther apart than least_m
// between two shares. With C = A x B, C . r is a cubic polynomial, which lies between its Bernstein
// coefficients.
bool staysApart(Kind kind, const Features& f, double from, double to, double least_m) {
  Linear A, B, r;
  vectorsOf(kind, f, from, to, A, B, r);
  const Vec3 C[3] = {A.from.cross(B.from), 0.5 * (A.from.cross(B.to) + A.to.cross(B.from)), A.to.cross(B.to)};
  const double h[4] = {C[0].dot(r.from), (C[0].dot(r.to) + 2 * C[1].dot(r.from)) / 3,
                       (2 * C[1].dot(r.to) + C[2].dot(r.from)) / 3, C[2].dot(r.to)};
  const double limit = least_m * std::max({C[0].norm(), C[1].norm(), C[2].norm()});
  const double sign = h[0] < 0 ? -1 : 1;
  return sign * h[0] > limit && sign * h[1] > limit && sign * h[2] > limit && sign * h[3] > limit;
}

// The share up to which staysApart() is known to hold; at least `least_share`.
double planeShare(Kind kind, const Features& f, double from, double least_share, double least_m) {
  double to = 1;
  for (int k = 0; k < kMostRounds && to > least_share; ++k, to = 0.5 * (from + to))
    if (staysApart(kind, f, from, to, least_m)) return to;
  return least_share;
}

}  // namespace

bool findApproach(Kind kind, const Features& f, double least_m, double start_m, Approach& reach) {
  const double near_m = 1.1 * least_m;
  double distance_m = start_m;
  double fastest_m = 0;
  for (int i = 0; i < f.a_count; ++i) fastest_m = std::max(fastest_m, f.way[i].norm());
  for (int k = 0; k < kMostIterations; ++k) {
    const Vec3 n = (reach.nearest.p - reach.nearest.q) / distance_m;
    // The slab is as wide as the distance, so it lasts at least until the fastest point has covered that
    // distance.
    const double least_step = fastest_m > 0 ? (distance_m - least_m) / fastest_m : 2;
    const double slab = std::max(slabShare(f, n, least_m), reach.share + least_step);
    if (!(slab < 1)) return false;
    // Tested because a long edge that turns soon leaves its slab, although the edges stay apart where they
    // are nearest.
    reach.share = planeShare(kind, f, reach.share, slab, least_m);
    if (!(reach.share < 1)) return false;
    Vec3 at[3];
    f.moveTo(reach.share, at);
    reach.nearest = nearestOf(kind, at, f.b);
    distance_m = reach.nearest.distance_m();
    if (distance_m <= near_m) return true;
  }
  return true;
}

}  // namespace vps
