// SPDX-License-Identifier: BSD-3-Clause
#include "revisions/surface_deviation.h"

#include <algorithm>
#include <array>
#include <queue>
#include <vector>

namespace vps::scenes {

namespace {

using Corners = std::array<Vec3, 3>;

/// A piece of a facet, and the greatest distance that a point of it may have.
struct Piece {
  Corners corners;
  double high_m = 0;
  std::size_t order = 0;  ///< ties are broken by age, so that the search is the same in each run
  bool operator<(const Piece& other) const {
    return high_m != other.high_m ? high_m < other.high_m : order > other.order;
  }
};

Corners facetOf(const Mesh& mesh, std::size_t i, const Pose& X) {
  const auto& t = mesh.triangles[i];
  return {X * mesh.vertices[t[0]], X * mesh.vertices[t[1]], X * mesh.vertices[t[2]]};
}

Vec3 middleOf(const Corners& c) {
  return (c[0] + c[1] + c[2]) / 3;
}

double areaOf(const Corners& c) {
  return 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm();
}

}  // namespace

DeviationBounds deviation(const Mesh& of, const Pose& X_FO, const MeshDistance& from) {
  constexpr std::size_t kMostPieces =
      60'000;  // assumed: enough for the rim of a changed face; a few tenths of a second
  constexpr double kShare = 0.01, kFine_m = 0.05e-6;
  double low_m = 0;
  std::priority_queue<Piece> open;
  std::size_t pieces = 0;
  const auto judge = [&](const Corners& c) {
    const MeshDistance::Closest nearest = from.closest(middleOf(c));
    const auto& t = from.mesh().triangles[nearest.triangle];
    double high_m = 0;
    for (const Vec3& corner : c) {
      const Vec3 q = closestOnTriangle(corner, from.mesh().vertices[t[0]], from.mesh().vertices[t[1]],
                                       from.mesh().vertices[t[2]])
                         .q;
      high_m = std::max(high_m, (corner - q).norm());
    }
    low_m = std::max(low_m, nearest.distance_m);
    open.push({c, high_m, pieces++});
  };
  for (const Vec3& p : of.vertices) low_m = std::max(low_m, from.closest(X_FO * p).distance_m);
  for (std::size_t i = 0; i < of.triangles.size(); ++i) judge(facetOf(of, i, X_FO));
  const std::size_t most = pieces + kMostPieces;
  while (!open.empty() && pieces < most && open.top().high_m > low_m + std::max(kShare * low_m, kFine_m)) {
    const Corners c = open.top().corners;
    open.pop();
    const Vec3 ab = 0.5 * (c[0] + c[1]), bc = 0.5 * (c[1] + c[2]), ca = 0.5 * (c[2] + c[0]);
    for (const Vec3& p : {ab, bc, ca}) low_m = std::max(low_m, from.closest(p).distance_m);
    for (const Corners& piece :
         {Corners{c[0], ab, ca}, Corners{ab, c[1], bc}, Corners{ca, bc, c[2]}, Corners{ab, bc, ca}})
      judge(piece);
  }
  return {low_m, open.empty() ? low_m : std::max(low_m, open.top().high_m)};
}

double meanDistance(const Mesh& of, const Pose& X_FO, const MeshDistance& from) {
  constexpr std::size_t kMostFacets = 2000;
  const std::size_t step = std::max<std::size_t>(1, of.triangles.size() / kMostFacets);
  double sum_m3 = 0, area_m2 = 0;
  for (std::size_t i = 0; i < of.triangles.size(); i += step) {
    const Corners c = facetOf(of, i, X_FO);
    sum_m3 += areaOf(c) * from.closest(middleOf(c)).distance_m;
    area_m2 += areaOf(c);
  }
  return area_m2 > 0 ? sum_m3 / area_m2 : 0;
}

}  // namespace vps::scenes
