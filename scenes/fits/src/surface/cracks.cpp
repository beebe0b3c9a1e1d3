// SPDX-License-Identifier: BSD-3-Clause
#include "surface/part_surface.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "vps/box.h"
#include "vps/stoppable.h"

namespace vps::scenes {

std::vector<std::array<std::uint32_t, 3>> neighboursOf(const Mesh& mesh) {
  struct Side {
    std::uint32_t low, high, triangle;
    int edge;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    for (int e = 0; e < 3; ++e) {
      const auto [low, high] = std::minmax(mesh.triangles[i][e], mesh.triangles[i][(e + 1) % 3]);
      sides.push_back({low, high, i, e});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle, a.edge) < std::tie(b.low, b.high, b.triangle, b.edge);
  });
  std::vector<std::array<std::uint32_t, 3>> out(mesh.triangles.size(), {kNoFacet, kNoFacet, kNoFacet});
  for (std::size_t first = 0, end = 0; first < sides.size(); first = end) {
    while (end < sides.size() && sides[end].low == sides[first].low && sides[end].high == sides[first].high)
      ++end;
    if (end - first != 2) continue;
    const Side &a = sides[first], &b = sides[first + 1];
    out[a.triangle][a.edge] = b.triangle;
    out[b.triangle][b.edge] = a.triangle;
  }
  return out;
}

bool isBalanced(const Mesh& mesh) {
  std::vector<std::pair<std::uint64_t, int>>
      sides;  // an edge by its ends, and the direction of a facet's side along it
  sides.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    for (std::size_t e = 0; e < 3; ++e) {
      const auto [low, high] = std::minmax(t[e], t[(e + 1) % 3]);
      sides.emplace_back(std::uint64_t{low} << 32 | high, t[e] == low ? 1 : -1);
    }
  std::ranges::sort(sides);
  for (std::size_t i = 0; i < sides.size();) {
    int sum = 0;
    for (const std::uint64_t edge = sides[i].first; i < sides.size() && sides[i].first == edge; ++i)
      sum += sides[i].second;
    if (sum != 0) return false;
  }
  return true;
}

std::vector<Crack> cracksOf(const Mesh& mesh, const std::vector<std::array<std::uint32_t, 3>>& neighbours,
                            const BoxTree& tree) {
  // Greatest width of a crack, as a share of an edge and as a share of the part's size; assumed.
  constexpr double kNarrow = 0.25, kWidest = 4e-3;
  constexpr double kWedge = 0.99;  // least cosine between the sides of a crack that ends in a corner
  struct OpenEdge {
    std::uint32_t from, to;
  };
  std::vector<OpenEdge> open;
  std::vector<std::vector<std::size_t>> of_facet(neighbours.size()), of_corner(mesh.vertices.size());
  for (std::uint32_t i = 0; i < neighbours.size(); ++i)
    for (int e = 0; e < 3; ++e) {
      if (neighbours[i][e] != kNoFacet) continue;
      const std::uint32_t from = mesh.triangles[i][e], to = mesh.triangles[i][(e + 1) % 3];
      for (std::vector<std::size_t>* list : {&of_facet[i], &of_corner[from], &of_corner[to]})
        list->push_back(open.size());
      open.push_back({from, to});
    }
  std::vector<Crack> cracks;
  const std::vector<Vec3>& v = mesh.vertices;
  const auto awayFrom = [&](std::uint32_t corner, std::size_t edge) {
    return (v[open[edge].from == corner ? open[edge].to : open[edge].from] - v[corner]).normalized();
  };
  const auto endsCrack = [&](std::uint32_t corner) {
    for (const std::size_t one : of_corner[corner])
      for (const std::size_t two : of_corner[corner])
        if (one < two && awayFrom(corner, one).dot(awayFrom(corner, two)) > kWedge) return true;
    return false;
  };
  const double most_m = kWidest * bounds(mesh).size().norm();
  for (const OpenEdge& edge : open) {
    pollStop();
    if (endsCrack(edge.from)) continue;
    const Vec3& p = v[edge.from];
    const double limit_m = std::min(most_m, kNarrow * (v[edge.to] - p).norm());
    double width_m = limit_m;
    const auto measure = [&](const OpenEdge& other) {
      const Vec3 along = v[other.to] - v[other.from];
      if (other.from == edge.from || other.to == edge.from || along.isZero(0)) return;
      const double share = std::clamp((p - v[other.from]).dot(along) / along.squaredNorm(), 0.0, 1.0);
      const double distance_m = (v[other.from] + share * along - p).norm();
      if (distance_m < kNarrow * along.norm()) width_m = std::min(width_m, distance_m);
    };
    tree.forEach(
        [&](const Box& node) {
          return distance2(node, Box{p, p}) < width_m * width_m;
        },
        [&](std::uint32_t facet) {
          for (const std::size_t other : of_facet[facet]) measure(open[other]);
        });
    if (width_m < limit_m && width_m > 0) cracks.push_back({p, width_m});
  }
  return cracks;
}

}  // namespace vps::scenes
