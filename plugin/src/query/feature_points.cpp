// SPDX-License-Identifier: BSD-3-Clause
#include "query/feature_points.h"

#include <algorithm>

#include "mesh/triangle_distance.h"
#include "vps/contact_tolerances.h"

namespace vps {

Nearest nearestOfSegments(const Vec3& p1, const Vec3& q1, const Vec3& p2, const Vec3& q2) {
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
  return nearestOfSegments(a[0], a[1], b[0], b[1]);
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

}  // namespace vps
