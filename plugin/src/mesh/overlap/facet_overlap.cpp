// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/overlap/overlap_search.h"
#include "vps/stoppable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace vps {

namespace {

constexpr int kProbes = 16;      ///< probes for a facet while no deeper point is found
constexpr int kMoreProbes = 80;  ///< probes for a facet once a deeper point is found
constexpr double kThin = 16;     ///< a gap is thin if this times the gap is less than a side of the piece
/// Cosine: the normals of flush faces differ by much less, the normals at edges by more.
constexpr double kParallel = 0.9;

using Polygon = std::vector<Vec3>;

/// The part of a convex polygon that is in a box.
Polygon clipped(Polygon polygon, const Box& box) {
  Polygon kept;
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    const double sign = side % 2 == 0 ? 1 : -1;
    const double limit = sign > 0 ? box.max[axis] : -box.min[axis];
    kept.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double beyond_a = sign * a[axis] - limit, beyond_b = sign * b[axis] - limit;
      if (beyond_a <= 0) kept.push_back(a);
      if ((beyond_a < 0 && beyond_b > 0) || (beyond_a > 0 && beyond_b < 0))
        kept.push_back(a + beyond_a / (beyond_a - beyond_b) * (b - a));
    }
    polygon.swap(kept);
  }
  return polygon;
}

/// An upper bound of the radius of the largest circle in a convex polygon: the area of the polygon is at
/// least half its circumference times that radius.
double greatestRadius_m(const Polygon& polygon) {
  Vec3 area2 = Vec3::Zero();
  double around_m = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    area2 += (a - polygon[0]).cross(b - polygon[0]);
    around_m += (b - a).norm();
  }
  return around_m > 0 ? area2.norm() / around_m : 0;
}

struct Piece {
  std::array<Vec3, 3> corners;
  double bound_m;  ///< upper bound of the depth of the piece's points
};

std::array<Piece, 2> halves(const Piece& piece, const Vec3& probe, double depth_m) {
  int longest = 0;
  const auto length2 = [&](int i) { return (piece.corners[(i + 1) % 3] - piece.corners[i]).squaredNorm(); };
  for (const int i : {1, 2})
    if (length2(i) > length2(longest)) longest = i;
  const Vec3 &a = piece.corners[longest], &b = piece.corners[(longest + 1) % 3],
             &c = piece.corners[(longest + 2) % 3];
  const Vec3 middle = 0.5 * (a + b);
  std::array<Piece, 2> out = {Piece{{a, middle, c}, 0}, Piece{{middle, b, c}, 0}};
  for (Piece& half : out) {
    double farthest_m = 0;
    for (const Vec3& corner : half.corners) farthest_m = std::max(farthest_m, (corner - probe).norm());
    half.bound_m = depth_m + farthest_m;  // distance is 1-Lipschitz
  }
  return out;
}

/// The depth above which a new depth is recorded. The depth at edges is kept unless a depth between edges is
/// twice as large; a depth between edges is refined to a sixteenth.
double needed_m(const Deepest& deepest) {
  return deepest.is_between_edges ? deepest.depth_m * (1 + 1.0 / 16)
                                  : 2 * deepest.depth_m + kOverlapCertain_m;
}

void record(Deepest& deepest, double depth_m, const Vec3& p_S) {
  if (depth_m > (deepest.is_between_edges ? deepest.depth_m : needed_m(deepest)))
    deepest = {depth_m, p_S, true};
}

class FacetSearch {
 public:
  FacetSearch(const OverlapMesh& in, Deepest& deepest) : in_(in), deepest_(deepest) {}

  void search(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Polygon polygon = clipped({a, b, c}, in_.box());
    // A point deeper than the facet's edges by d is the centre of a circle of radius d in the overlap.
    if (polygon.size() < 3 || greatestRadius_m(polygon) <= needed_m(deepest_) - deepest_.depth_m) return;
    normal_S_ = (b - a).cross(c - a).normalized();
    pieces_.clear();
    for (std::size_t i = 2; i < polygon.size(); ++i)
      pieces_.push_back({{polygon[0], polygon[i - 1], polygon[i]}, 1e300});
    for (int probes = 0; !pieces_.empty() && probes < (deepest_.is_between_edges ? kMoreProbes : kProbes);
         ++probes)
      probeNext();
  }
  [[nodiscard]] std::vector<FlushPoint> takeFlush() { return std::move(flush_); }

 private:
  void probeNext() {
    const auto next = std::max_element(pieces_.begin(), pieces_.end(),
                                       [](const Piece& a, const Piece& b) { return a.bound_m < b.bound_m; });
    const Piece piece = *next;
    pieces_.erase(next);
    if (piece.bound_m <= needed_m(deepest_)) return pieces_.clear();
    const Vec3 probe = (piece.corners[0] + piece.corners[1] + piece.corners[2]) / 3;
    const Solid::Closest nearest = in_.solid().closest(probe);
    const double depth_m =
        nearest.normal.dot(probe - nearest.q) > 0 ? -nearest.distance_m : nearest.distance_m;
    const double facing = nearest.normal.dot(normal_S_);
    record(deepest_, depth_m, probe);
    if (std::abs(depth_m) <= kOverlapCertain_m && facing > kParallel) flush_.push_back({probe, normal_S_});
    // Two faces that are in contact, or have a gap that is thin compared with the piece, need no finer
    // pieces.
    const double contact_m = deepest_.is_between_edges ? kOverlapCertain_m : needed_m(deepest_);
    const double gap_m = kOverlapCertain_m + (piece.corners[1] - piece.corners[0]).norm() / kThin;
    if (depth_m >= -gap_m && depth_m <= contact_m && facing < -kParallel) return;
    for (const Piece& half : halves(piece, probe, depth_m))
      if (half.bound_m > needed_m(deepest_)) pieces_.push_back(half);
  }

  const OverlapMesh& in_;
  Deepest& deepest_;
  Vec3 normal_S_ = Vec3::Zero();
  std::vector<Piece> pieces_;
  std::vector<FlushPoint> flush_;
};

}  // namespace

std::vector<FlushPoint> searchFacets(const OverlapMesh& in, const OverlapMesh& other, const Pose& X_SO,
                                     std::span<const std::uint32_t> facets, Deepest& deepest) {
  FacetSearch search(in, deepest);
  const std::vector<Vec3>& v = other.mesh().vertices;
  for (const std::uint32_t facet : facets) {
    pollStop();
    const auto& t = other.mesh().triangles[facet];
    search.search(X_SO * v[t[0]], X_SO * v[t[1]], X_SO * v[t[2]]);
  }
  return search.takeFlush();
}

void searchBelow(const OverlapMesh& in, const OverlapMesh& other, const Pose& X_SO,
                 std::span<const FlushPoint> points, Deepest& deepest) {
  const Pose X_OS = X_SO.inverse();
  const double reach_m = in.box().size().norm();
  std::vector<double> crossings;
  for (const auto& [p_S, normal_S] : points) {
    pollStop();
    const Vec3 end = p_S - reach_m * normal_S;
    crossings.clear();
    in.solid().appendCrossings(p_S, end, crossings);
    other.solid().appendCrossings(X_OS * p_S, X_OS * end, crossings);
    double nearest = 1;
    for (const double fraction : crossings)
      if (fraction * reach_m > kOverlapCertain_m) nearest = std::min(nearest, fraction);
    const Vec3 middle = p_S + 0.5 * nearest * (end - p_S);
    record(deepest, -std::max(in.solid().signedDistance(middle), other.solid().signedDistance(X_OS * middle)),
           middle);
  }
}

}  // namespace vps
