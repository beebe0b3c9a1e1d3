// SPDX-License-Identifier: BSD-3-Clause
// The inner loop of MeshDistance and of the voxeliser, in a header so that both inline the same arithmetic
// and get the same bits.
#pragma once

#include <algorithm>

#include "vps/mesh_distance.h"

namespace vps {

/// Distance of p from segment ab.
inline double distanceToSegment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - t * along).norm();
}

/// Closest point of segment ab; its feature is `segment`, `at_a` or `at_b`.
inline TrianglePoint closestOnSegment(const Vec3& p, const Vec3& a, const Vec3& b, int segment, int at_a,
                                      int at_b) noexcept {
  const Vec3 ab = b - a;
  const double along = ab.dot(p - a), length2 = ab.squaredNorm();
  if (!(along > 0)) return {a, at_a};
  if (along >= length2) return {b, at_b};
  return {a + (along / length2) * ab, segment};
}

/// See closestOnTriangle(). The plane is divided into the seven regions nearest to each feature; dot products
/// with two edges from each corner tell the region into which p projects. Source: Ericson, section 5.1.5.
inline TrianglePoint closestOnTriangleInline(const Vec3& p, const Vec3& a, const Vec3& b,
                                             const Vec3& c) noexcept {
  const Vec3 ab = b - a, ac = c - a;
  const Vec3 ap = p - a;
  const double ab_ap = ab.dot(ap), ac_ap = ac.dot(ap);
  if (ab_ap <= 0 && ac_ap <= 0) return {a, 4};

  const Vec3 bp = p - b;
  const double ab_bp = ab.dot(bp), ac_bp = ac.dot(bp);
  if (ab_bp >= 0 && ac_bp <= ab_bp) return {b, 5};

  const Vec3 cp = p - c;
  const double ab_cp = ab.dot(cp), ac_cp = ac.dot(cp);
  if (ac_cp >= 0 && ab_cp <= ac_cp) return {c, 6};

  // Barycentric weights of the projection, times twice the squared area. A weight that is not positive means
  // that the projection is beyond the opposite edge.
  const double weight_c = ab_ap * ac_bp - ab_bp * ac_ap;
  if (weight_c <= 0 && ab_ap >= 0 && ab_bp <= 0) return {a + (ab_ap / (ab_ap - ab_bp)) * ab, 1};
  const double weight_b = ab_cp * ac_ap - ab_ap * ac_cp;
  if (weight_b <= 0 && ac_ap >= 0 && ac_cp <= 0) return {a + (ac_ap / (ac_ap - ac_cp)) * ac, 3};
  const double weight_a = ab_bp * ac_cp - ab_cp * ac_bp;
  const double toward_c = ac_bp - ab_bp, toward_b = ab_cp - ac_cp;
  if (weight_a <= 0 && toward_c >= 0 && toward_b >= 0)
    return {b + (toward_c / (toward_c + toward_b)) * (c - b), 2};

  const double sum = weight_a + weight_b + weight_c;
  // With collinear corners only rounding noise is left here; the nearest point is then on an edge.
  const double noise = 1e-14 * ab.squaredNorm() * ac.squaredNorm();
  if (sum > noise) return {a + (weight_b / sum) * ab + (weight_c / sum) * ac, 0};
  const TrianglePoint sides[3] = {closestOnSegment(p, a, b, 1, 4, 5), closestOnSegment(p, b, c, 2, 5, 6),
                                  closestOnSegment(p, c, a, 3, 6, 4)};
  const TrianglePoint* best = &sides[0];
  for (const TrianglePoint& side : sides)
    if ((p - side.q).squaredNorm() < (p - best->q).squaredNorm()) best = &side;
  return *best;
}

}  // namespace vps
