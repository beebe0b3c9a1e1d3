// SPDX-License-Identifier: BSD-3-Clause
// The deepest overlap of two meshes at given poses, by exact distance; no voxmap takes part.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "vps/box.h"
#include "vps/mesh.h"
#include "vps/mesh_distance.h"
#include "vps/sharp_edges.h"

namespace vps::test {

/// A closed mesh with what measuring it needs.
struct MeasuredPart {
  std::shared_ptr<const MeshDistance> exact;
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< where faces turn by more than half a degree
  Box box;
};

inline MeasuredPart measured(const Mesh& mesh) {
  constexpr double kFlat_rad = 0.009;
  return {std::make_shared<MeshDistance>(mesh), sharpEdges(mesh, kFlat_rad), bounds(mesh)};
}

/// A point of an edge, with its signed distance from the solid and the facet nearest to it.
struct MeasuredPoint {
  Vec3 p = Vec3::Zero();
  double f_m = 0;
  std::uint32_t facet = 0;
};

inline MeasuredPoint measure(const MeshDistance& solid, const Vec3& p) {
  const MeshDistance::Closest closest = solid.closest(p);
  return {p, closest.normal.dot(p - closest.q) < 0 ? -closest.distance_m : closest.distance_m,
          closest.triangle};
}

/// Greatest depth [m] of the edges of `other` in `solid`; 0 if none is inside. An edge is bisected until no
/// point of it can be deeper than the result by 0.1 um. Two bounds say so: the signed distance is 1-Lipschitz
/// along the edge; and where the feet of both ends lie on one facet, that facet is below all of the piece, so
/// that no point of it is deeper than its ends are far from the facet.
inline double edgeDepth_m(const MeasuredPart& solid, const MeasuredPart& other, const Pose& X_SO,
                          double depth_m = 0) {
  constexpr double kCertain_m = 0.1e-6;
  std::vector<std::array<MeasuredPoint, 2>> pieces;
  const auto isApart = [&](const Vec3& a, const Vec3& b) {
    for (int k = 0; k < 3; ++k)
      if (std::max(a[k], b[k]) < solid.box.min[k] || std::min(a[k], b[k]) > solid.box.max[k]) return true;
    return false;
  };
  for (const auto& edge : other.edges) {
    const Vec3 a = X_SO * other.exact->mesh().vertices[edge[0]],
               b = X_SO * other.exact->mesh().vertices[edge[1]];
    if (isApart(a, b)) continue;
    pieces.assign(1, {measure(*solid.exact, a), measure(*solid.exact, b)});
    depth_m = std::max({depth_m, -pieces[0][0].f_m, -pieces[0][1].f_m});
    while (!pieces.empty()) {
      const auto [from, to] = pieces.back();
      pieces.pop_back();
      const double deepest_m = 0.5 * ((to.p - from.p).norm() - from.f_m - to.f_m);
      const double to_facet_m = std::max(std::abs(from.f_m), std::abs(to.f_m));
      if (deepest_m <= depth_m + kCertain_m) continue;
      if (from.facet == to.facet && to_facet_m <= depth_m + kCertain_m) continue;
      const MeasuredPoint mid = measure(*solid.exact, 0.5 * (from.p + to.p));
      depth_m = std::max(depth_m, -mid.f_m);
      pieces.push_back({from, mid});
      pieces.push_back({mid, to});
    }
  }
  return depth_m;
}

/// Greatest depth [m] of either part's edges in the other. Two surfaces that cross do so at an edge of one of
/// them, and on a part of flat faces the deepest point lies on an edge.
inline double overlap_m(const MeasuredPart& a, const Pose& X_WA, const MeasuredPart& b, const Pose& X_WB) {
  const Pose X_AB = X_WA.inverse() * X_WB;
  return edgeDepth_m(b, a, X_AB.inverse(), edgeDepth_m(a, b, X_AB));
}

}  // namespace vps::test
