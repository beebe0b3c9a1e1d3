// SPDX-License-Identifier: BSD-3-Clause
#include "vps/mesh_overlap.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh/overlap/overlap_search.h"

namespace vps {

namespace {

void keep(PointDepth& deepest, double depth_m, const Vec3& p_S) {
  if (depth_m > deepest.depth_m) deepest = {depth_m, p_S};
}

/// A point of a segment, its signed distance, and the triangle that is nearest to it.
struct Probe {
  Vec3 p;
  double signed_m = 0;
  std::uint32_t triangle = 0;

  Probe(const Solid& solid, const Vec3& point, double most_m) : p(point) {
    const Solid::Closest nearest = solid.closest(point, most_m);
    const bool is_inside = nearest.found && nearest.normal.dot(point - nearest.q) < 0;
    signed_m = is_inside ? -nearest.distance_m : nearest.distance_m;
    triangle = nearest.triangle;
  }
  /// 1 outside, -1 inside; 0 nearer to the surface than certain_m, where the point may be on either side.
  [[nodiscard]] int side(double certain_m) const {
    return std::abs(signed_m) <= certain_m ? 0 : signed_m > 0 ? 1 : -1;
  }
};

/// A search limit slightly above the distance, so that the search is certain to find the nearest triangle.
double reached(double distance_m) {
  return distance_m * (1 + 1e-12) + 1e-12;
}

/// Searches without the use of crossings, for surfaces that may have holes.
void searchAnywhere(const Solid& solid, const Probe& from, const Probe& to, double certain_m,
                    PointDepth& deepest) {
  struct Piece {
    Probe a, b;
  };
  std::vector<Piece> stack{{from, to}};
  while (!stack.empty()) {
    const Piece piece = stack.back();
    stack.pop_back();
    const Vec3 &a = piece.a.p, &b = piece.b.p;
    const double length_m = (b - a).norm();
    // The signed distance f is 1-Lipschitz: on a segment it is at least (f(a) + f(b) - |ab|) / 2.
    const double by_slope_m = 0.5 * (length_m - piece.a.signed_m - piece.b.signed_m);
    if (!(by_slope_m > deepest.depth_m + certain_m)) continue;
    const double by_triangle_m =
        std::min(std::max(std::abs(piece.a.signed_m), distanceToTriangle(solid, piece.a.triangle, b)),
                 std::max(std::abs(piece.b.signed_m), distanceToTriangle(solid, piece.b.triangle, a)));
    if (!(by_triangle_m > deepest.depth_m + certain_m)) continue;
    const double most_m = std::min(std::abs(piece.a.signed_m), std::abs(piece.b.signed_m)) + 0.5 * length_m;
    const Probe middle(solid, 0.5 * (a + b), reached(most_m));
    keep(deepest, -middle.signed_m, middle.p);
    // No floating-point number lies between the ends of the piece.
    if ((middle.p - a).norm() == 0 || (middle.p - b).norm() == 0) continue;
    stack.push_back({piece.a, middle});
    stack.push_back({middle, piece.b});
  }
}

/// True if the pieces between crossings are alternately inside and outside. This order holds unless rounding
/// has lost or added a crossing.
bool doAlternate(const Solid& solid, const Probe& from, const Probe& to, const std::vector<double>& ends,
                 double certain_m) {
  const double length_m = (to.p - from.p).norm();
  // An end on the surface, and a piece shorter than certain_m, may be on either side.
  int before = from.side(certain_m);
  bool is_same_stretch = true;  // as the end before it
  double begin = 0;
  for (const double end : ends) {
    if ((end - begin) * length_m > certain_m && ends.size() > 1) {
      const int side = Probe(solid, from.p + 0.5 * (begin + end) * (to.p - from.p), 1e300).side(certain_m);
      if (side * before == (is_same_stretch ? -1 : 1)) return false;
      before = side;
      is_same_stretch = false;
    }
    begin = end;
  }
  const int last = to.side(certain_m);
  // Without crossings both ends are on the same side; otherwise the last piece ends with the segment.
  return last * before != -1 || (ends.size() > 1 && (1 - ends[ends.size() - 2]) * length_m <= certain_m);
}

}  // namespace

double distanceToTriangle(const Solid& solid, std::uint32_t triangle, const Vec3& p) {
  const auto& t = solid.mesh().triangles[triangle];
  const auto& v = solid.mesh().vertices;
  return (closestOnTriangle(p, v[t[0]], v[t[1]], v[t[2]]).q - p).norm();
}

// The depth of a point is the distance to the nearest triangle, so it is at most the distance to any one
// triangle. That distance is convex along the segment, so it is at most the value at the farther end.
bool searchUncrossed(const Solid& solid, const Vec3& a, const Vec3& b, double certain_m, double& depth_m,
                     Vec3& p_S) {
  struct Piece {
    Vec3 a, b;
  };
  std::vector<Piece> stack{{a, b}};
  bool is_first = true;
  while (!stack.empty()) {
    const Piece piece = stack.back();
    stack.pop_back();
    const Vec3 middle = 0.5 * (piece.a + piece.b);
    const Solid::Closest nearest = solid.closest(middle);
    const bool is_outside = !(nearest.normal.dot(middle - nearest.q) < 0);
    if (is_first && is_outside) return nearest.distance_m <= certain_m;
    is_first = false;
    const double farther_end_m = std::max(distanceToTriangle(solid, nearest.triangle, piece.a),
                                          distanceToTriangle(solid, nearest.triangle, piece.b));
    const double half_m = 0.5 * (piece.b - piece.a).norm();
    const double signed_m = is_outside ? -nearest.distance_m : nearest.distance_m;
    if (!(std::min(farther_end_m, signed_m + half_m) > depth_m + certain_m)) continue;
    if (signed_m > depth_m) {
      depth_m = signed_m;
      p_S = middle;
    }
    if ((middle - piece.a).norm() == 0 || (middle - piece.b).norm() == 0) continue;  // rounding
    stack.push_back({piece.a, middle});
    stack.push_back({middle, piece.b});
  }
  return true;
}

PointDepth deepestOnSegment(const Solid& solid, const Vec3& a, const Vec3& b, double certain_m) {
  PointDepth deepest;
  if (solid.isSheet() || !a.allFinite() || !b.allFinite()) return deepest;
  const Probe from(solid, a, 1e300), to(solid, b, reached(std::abs(from.signed_m) + (b - a).norm()));
  keep(deepest, -from.signed_m, a);
  keep(deepest, -to.signed_m, b);
  thread_local std::vector<double> ends;
  ends.clear();
  if (!solid.isByWinding()) solid.appendCrossings(a, b, ends);
  std::sort(ends.begin(), ends.end());
  ends.push_back(1);
  if (solid.isByWinding() || !doAlternate(solid, from, to, ends, certain_m)) {
    searchAnywhere(solid, from, to, certain_m, deepest);
    return deepest;
  }
  if (ends.size() == 1 && from.signed_m > 0) return deepest;
  double begin = 0;
  for (const double end : ends) {
    if (end > begin)
      searchUncrossed(solid, a + begin * (b - a), a + end * (b - a), certain_m, deepest.depth_m, deepest.p_S);
    begin = end;
  }
  return deepest;
}

}  // namespace vps
