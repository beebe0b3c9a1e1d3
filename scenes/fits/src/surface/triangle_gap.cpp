// SPDX-License-Identifier: BSD-3-Clause
#include "surface/triangle_gap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace vps::scenes {

namespace {

double clamped(double x) {
  return std::clamp(x, 0.0, 1.0);
}

Vec3 at(const Vec3& a, const Vec3& b, double fraction) {
  return a + fraction * (b - a);
}

int featureAt(int edge, double fraction) {
  if (fraction <= 0) return 4 + edge;
  return fraction >= 1 ? 4 + (edge + 1) % 3 : 1 + edge;
}

/// The point where segment pq passes through triangle t; empty if the segment does not pass through the
/// triangle, or lies in the triangle's plane.
std::optional<Vec3> crossing(const Vec3& p, const Vec3& q, const Triangle& t) {
  const Vec3 u = t[1] - t[0], v = t[2] - t[0], n = u.cross(v);
  const double above_p = n.dot(p - t[0]), above_q = n.dot(q - t[0]);
  if ((above_p > 0) == (above_q > 0)) return std::nullopt;
  const Vec3 x = at(p, q, above_p / (above_p - above_q)), r = x - t[0];
  const double n2 = n.squaredNorm(), along_u = r.cross(v).dot(n) / n2, along_v = u.cross(r).dot(n) / n2;
  if (along_u < 0 || along_v < 0 || along_u + along_v > 1) return std::nullopt;
  return x;
}

void keepCorners(const Triangle& of, const Triangle& on, bool is_of_a, TriangleGap& best) {
  for (int i = 0; i < 3; ++i) {
    const TrianglePoint nearest = closestOnTriangle(of[i], on[0], on[1], on[2]);
    const double distance_m = (nearest.q - of[i]).norm();
    if (!(distance_m < best.distance_m)) continue;
    if (is_of_a)
      best = {distance_m, of[i], nearest.q, 4 + i, nearest.feature};
    else
      best = {distance_m, nearest.q, of[i], nearest.feature, 4 + i};
  }
}

}  // namespace

std::array<double, 2> nearestOfSegments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = d - c, r = a - c;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), vr = v.dot(r), ur = u.dot(r), uv = u.dot(v);
  if (uu == 0) return {0, vv == 0 ? 0 : clamped(vr / vv)};
  if (vv == 0) return {clamped(-ur / uu), 0};
  const double area2 = uu * vv - uv * uv;
  // For segments that are parallel up to rounding, any s serves; the clamps below then find the nearest
  // points.
  double s = area2 > 1e-14 * uu * vv ? clamped((uv * vr - ur * vv) / area2) : 0;
  double t = (uv * s + vr) / vv;
  if (t < 0) return {clamped(-ur / uu), 0};
  if (t > 1) return {clamped((uv - ur) / uu), 1};
  return {s, t};
}

TriangleGap triangleGap(const Triangle& a, const Triangle& b) {
  TriangleGap best;
  best.distance_m = 1e300;
  keepCorners(a, b, true, best);
  keepCorners(b, a, false, best);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      const Vec3 &p = a[i], &q = a[(i + 1) % 3], &r = b[k], &s = b[(k + 1) % 3];
      const auto [along_a, along_b] = nearestOfSegments(p, q, r, s);
      const Vec3 p_a = at(p, q, along_a), p_b = at(r, s, along_b);
      const double distance_m = (p_a - p_b).norm();
      if (distance_m < best.distance_m)
        best = {distance_m, p_a, p_b, featureAt(i, along_a), featureAt(k, along_b)};
    }
  if (best.distance_m == 0) return best;
  for (int i = 0; i < 3; ++i) {
    if (const auto x = crossing(a[i], a[(i + 1) % 3], b)) return {0, *x, *x, 1 + i, 0};
    if (const auto x = crossing(b[i], b[(i + 1) % 3], a)) return {0, *x, *x, 0, 1 + i};
  }
  return best;
}

double distanceOfOrigin(const std::array<Eigen::Vector2d, 3>& corners) {
  double nearest_m = std::numeric_limits<double>::infinity();
  int left = 0, right = 0;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d &a = corners[std::size_t(i)], edge = corners[std::size_t((i + 1) % 3)] - a;
    const double turn = edge.x() * a.y() - edge.y() * a.x();
    if (turn > 0) ++left;
    if (turn < 0) ++right;
    const double length2 = edge.squaredNorm();
    const double share = length2 > 0 ? std::clamp(-a.dot(edge) / length2, 0.0, 1.0) : 0.0;
    nearest_m = std::min(nearest_m, (a + share * edge).norm());
  }
  return left == 3 || right == 3 ? 0 : nearest_m;
}

}  // namespace vps::scenes
