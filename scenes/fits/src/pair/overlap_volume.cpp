// SPDX-License-Identifier: BSD-3-Clause
#include "pair/pair_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "surface/surface_piece.h"
#include "vps/box_intersection.h"
#include "vps/stoppable.h"

namespace vps::scenes {

namespace {

/// A triangle with its plane.
struct Flat {
  Triangle t;
  Vec3 n;  // normal; its length is twice the area
  explicit Flat(const Triangle& of) : t(of), n((of[1] - of[0]).cross(of[2] - of[0])) {}
  [[nodiscard]] double above(const Vec3& p) const { return n.dot(p - t[0]); }
  /// Twice the signed area of the triangle with the corners t[0], p and q.
  [[nodiscard]] double sweep(const Vec3& p, const Vec3& q) const {
    return (p - t[0]).cross(q - t[0]).dot(n) / n.norm();
  }
};

/// Clips segment pq, which lies in the plane of the triangle, to the triangle. Returns false if nothing of
/// the segment is left.
bool clip(const Flat& in, Vec3& p, Vec3& q) {
  const auto [from, to] = sharesWithin(in.t, in.n, p, q);
  if (!(from < to)) return false;
  const Vec3 first = p + from * (q - p);
  q = p + to * (q - p);
  p = first;
  return true;
}

/// Twice the signed area of the triangle spanned by t[0] and the segment in which `cutting` meets the
/// triangle. The segment has the inside of cutting's solid on its left.
double sweepOfCut(const Flat& of, const Flat& cutting) {
  Vec3 ends[2];
  int count = 0;
  double above[3];
  for (int i = 0; i < 3; ++i) above[i] = of.above(cutting.t[i]);
  for (int i = 0; i < 3 && count < 2; ++i) {
    const int k = (i + 1) % 3;
    if ((above[i] > 0) != (above[k] > 0))
      ends[count++] = cutting.t[i] + above[i] / (above[i] - above[k]) * (cutting.t[k] - cutting.t[i]);
  }
  if (count < 2) return 0;
  if ((ends[1] - ends[0]).dot(of.n.cross(cutting.n)) < 0) std::swap(ends[0], ends[1]);
  return clip(of, ends[0], ends[1]) ? of.sweep(ends[0], ends[1]) : 0;
}

/// Twice the signed area spanned by t[0] and the pieces of the triangle's sides that are inside the solid.
double sweepOfSides(const Flat& of, const PartSurface& solid, std::vector<double>& crossings) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3 &a = of.t[i], &b = of.t[(i + 1) % 3];
    crossings.clear();
    solid.overlap().solid().appendCrossings(a, b, crossings);
    std::sort(crossings.begin(), crossings.end());
    crossings.push_back(1);
    double from = 0;
    for (const double to : crossings) {
      // A crossing at the edge between two triangles is found twice, with values that differ by rounding.
      if (to > from + 1e-14 && solid.solid().isInside(a + 0.5 * (from + to) * (b - a)))
        sum += of.sweep(a + from * (b - a), a + to * (b - a));
      from = to;
    }
  }
  return sum;
}

/// The contribution of one surface to the volume.
struct Flux {
  double volume_m3 = 0, area_m2 = 0;
  Vec3 vector_area_S = Vec3::Zero();  // sum of the vector areas [m2], in the frame of the solid
  double wrong_m2 = 0;                // sum by which computed areas were below zero or above the facet's area
  double faces_m3 = 0;                // volume between the facets and the curved faces that they approximate
};

/// The area of a curved face's facet that may be inside the solid. Where the solid's faces are curved too and
/// within their chord error of the facet, the whole facet counts.
double areaOfFace(const Flat& facet, double inside_m2, const PartSurface& solid) {
  const double all_m2 = 0.5 * facet.n.norm();
  Box box;
  for (const Vec3& p : facet.t) box.add(p);
  const double chord_m = inside_m2 < all_m2 ? solid.chordIn(box) : 0;
  if (chord_m == 0) return inside_m2;
  const Vec3 middle = (facet.t[0] + facet.t[1] + facet.t[2]) / 3;
  double reach_m = 0;
  for (const Vec3& p : facet.t) reach_m = std::max(reach_m, (p - middle).norm());
  return solid.solid().signedDistance(middle) <= reach_m + chord_m ? all_m2 : inside_m2;
}

/// Contribution to the volume of the part of `of`'s surface that is inside `solid` (divergence theorem).
/// @param X_SO pose of `of` in the solid's frame
/// @param p_S apex of the cones whose volumes are summed, in the solid's frame
Flux fluxInside(const PartSurface& of, const PartSurface& solid, const Pose& X_SO, const Vec3& p_S) {
  Flux flux;
  std::vector<double> crossings;
  const Box box_O = moved(solid.box(), X_SO.inverse());
  of.tree().forEach([&](const Box& node) { return distance2(node, box_O) == 0; },
                    [&](std::uint32_t i) {
                      pollStop();
                      const Triangle t = of.triangle(i);
                      const Flat facet({X_SO * t[0], X_SO * t[1], X_SO * t[2]});
                      const double length2 = facet.n.norm();
                      if (!(length2 > 0)) return;
                      Box box;
                      for (const Vec3& p : facet.t) box.add(p);
                      if (distance2(box, solid.box()) > 0) return;
                      double sweep2 = sweepOfSides(facet, solid, crossings);
                      solid.tree().forEach(
                          [&](const Box& node) { return distance2(node, box) == 0; },
                          [&](std::uint32_t k) { sweep2 += sweepOfCut(facet, Flat(solid.triangle(k))); });
                      const double area_m2 = std::clamp(0.5 * sweep2, 0.0, 0.5 * length2);
                      flux.area_m2 += area_m2;
                      flux.wrong_m2 += std::abs(0.5 * sweep2 - area_m2);
                      if (of.chord_m(i) > 0)
                        flux.faces_m3 += of.chord_m(i) * areaOfFace(facet, area_m2, solid);
                      flux.vector_area_S += area_m2 / length2 * facet.n;
                      flux.volume_m3 += area_m2 * facet.n.dot(facet.t[0] - p_S) / length2 / 3;
                    });
  return flux;
}

/// The area of the surface's holes: for each group of connected open edges, the length of its vector area.
/// Cracks without width have no area.
double holeArea(const PartSurface& part) {
  if (!part.solid().isByWinding()) return 0;
  const Mesh& mesh = part.mesh();
  std::vector<std::array<std::uint32_t, 2>> open;
  // The groups are a union-find structure: each vertex leads to another vertex of its group.
  std::vector<std::uint32_t> group(mesh.vertices.size());
  std::iota(group.begin(), group.end(), 0U);
  const auto groupOf = [&](std::uint32_t v) {
    while (group[v] != v) v = group[v] = group[group[v]];
    return v;
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t e = 0; e < 3; ++e) {
      if (part.neighbours()[i][e] != kNoFacet) continue;
      open.push_back({mesh.triangles[i][e], mesh.triangles[i][(e + 1) % 3]});
      group[groupOf(open.back()[0])] = groupOf(open.back()[1]);
    }
  std::map<std::uint32_t, Vec3> twice_m2;
  for (const auto& [from, to] : open) {
    const std::uint32_t of = groupOf(from);
    const Vec3& p = mesh.vertices[of];
    twice_m2.try_emplace(of, Vec3::Zero()).first->second +=
        (mesh.vertices[from] - p).cross(mesh.vertices[to] - p);
  }
  double sum_m2 = 0;
  for (const auto& [of, vector_m2] : twice_m2) sum_m2 += 0.5 * vector_m2.norm();
  return sum_m2;
}

}  // namespace

OverlapVolume overlapVolume(const PartSurface& a, const PartSurface& b, const Pose& X_AB) {
  // A direction that is not parallel to usual faces of drawings.
  const Vec3 shift = kVolumeShift_m * Vec3(0.4242, 0.5657, 0.7071).normalized();
  const Pose X_AS(X_AB.R, X_AB.p + shift), X_SA = X_AS.inverse();
  const Box box_B = moved(b.box(), X_AS);
  const Box both = intersection(a.box(), box_B);
  if (both.isEmpty()) return {};
  const Vec3 p_A = both.center();
  const Flux of_a = fluxInside(a, b, X_SA, X_SA * p_A), of_b = fluxInside(b, a, X_AS, p_A);
  OverlapVolume out;
  out.area_m2 = of_a.area_m2 + of_b.area_m2;
  // The error of shifting each face by kVolumeShift_m, and of rounding each coordinate.
  const double round_m = 1e-14 * (p_A.norm() + both.size().norm());
  out.error_m3 = out.area_m2 * (kVolumeShift_m + round_m);
  // The vector areas of a closed surface sum to zero. A missing or superfluous piece changes the volume by
  // its area times a third of its height above p_A, which is at most half the diagonal. Pieces whose vector
  // areas cancel, such as two opposite holes, are covered by the area of the holes.
  const double left_m2 = (X_AS.R * of_a.vector_area_S + of_b.vector_area_S).norm();
  const double holes_m2 = std::min(out.area_m2, holeArea(a) + holeArea(b));
  out.error_m3 += (left_m2 + of_a.wrong_m2 + of_b.wrong_m2 + holes_m2) * 0.5 * both.size().norm() / 3;
  out.faces_error_m3 = of_a.faces_m3 + of_b.faces_m3;
  out.volume_m3 = std::max(0.0, of_a.volume_m3 + of_b.volume_m3);
  return out;
}

}  // namespace vps::scenes
