// SPDX-License-Identifier: BSD-3-Clause
#include "tiles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace vps::bench {

namespace {

// The cell of a direction, among 6 x 2 x 2 cells of a cube's surface.
std::uint64_t directionOf(const Vec3& n) {
  int axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  return static_cast<std::uint64_t>(((axis * 2 + (n[axis] > 0)) * 2 + (n[u] > 0)) * 2 + (n[v] > 0));
}

std::uint64_t tileOf(const Vec3& p, const Vec3& n, double tile_m) {
  std::uint64_t key = directionOf(n);
  for (int k = 0; k < 3; ++k)
    key = key << 19 |
          (static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(p[k] / tile_m))) & 0x7FFFF);
  return key;
}

/// A reading in its tile.
struct Placed {
  std::uint64_t tile;
  double least_m;
  const Reading* reading;
};

Count closeTile(std::span<const Placed> tile, double reach_m) {
  Count count;
  double best_m = std::numeric_limits<double>::infinity();
  for (const Placed& at : tile) {
    if (at.least_m > reach_m || best_m <= at.least_m) break;
    best_m = std::min(best_m, at.reading->distance_m);
    count.exact += 1;
    count.beside_edges += at.reading->is_beside_edge;
  }
  count.tiles = count.exact > 0;
  count.most = count.exact;
  return count;
}

// Sets the bound of each point to the greatest error of the points in its leaf.
void boundByLeaf(const PointShell& shell, std::vector<Reading>& readings,
                 const std::vector<std::uint32_t>& ids) {
  std::size_t i = 0;
  for (std::size_t leaf = 0; leaf < shell.leaf_blocks; ++leaf) {
    const std::uint32_t end_id = shell.blocks[leaf].first + shell.blocks[leaf].count;
    std::size_t end = i;
    double most_m = 0;
    for (; end < ids.size() && ids[end] < end_id; ++end)
      most_m = std::max(most_m, readings[end].reading_m - readings[end].distance_m);
    for (; i < end; ++i) readings[i].bound_m[static_cast<std::size_t>(Bound::ShellLeaf)] = most_m;
  }
}

}  // namespace

void Count::add(const Count& other) {
  tiles += other.tiles;
  exact += other.exact;
  beside_edges += other.beside_edges;
  broken += other.broken;
  most = std::max(most, other.most);
}

std::vector<Reading> readPoints(const PartModel& points_of, const PartModel& in, FieldError& error,
                                const Pose& X_MP, double near_m) {
  std::vector<Reading> readings;
  std::vector<std::uint32_t> ids;
  const PointShell& shell = *points_of.shell;
  for (std::uint32_t id = 0; id < shell.size(); ++id) {
    const Vec3 p_M = X_MP * shell.points[id];
    Reading r;
    r.reading_m = in.map->distance(p_M);
    if (r.reading_m > near_m) continue;
    r.p = shell.points[id];
    r.inward = shell.inward[id];
    r.distance_m = in.solid->signedDistance(p_M, 4 * near_m);
    r.is_beside_edge = error.isBesideEdge(p_M);
    for (const Bound bound : kBounds)
      if (bound != Bound::ShellLeaf) r.bound_m[static_cast<std::size_t>(bound)] = error.bound_m(bound, p_M);
    readings.push_back(r);
    ids.push_back(id);
  }
  boundByLeaf(shell, readings, ids);
  return readings;
}

Count closeTiles(const std::vector<Reading>& readings, double tile_m, Bound bound, double reach_m) {
  constexpr double kRounding_m = 1e-8;
  Count count;
  std::vector<Placed> placed;
  for (const Reading& r : readings) {
    placed.push_back({tileOf(r.p, r.inward, tile_m), r.least_m(bound), &r});
    count.broken += r.distance_m < r.least_m(bound) - kRounding_m;
  }
  std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    return a.tile != b.tile ? a.tile < b.tile : a.least_m < b.least_m;
  });
  for (std::size_t i = 0; i < placed.size();) {
    const std::size_t first = i;
    while (i < placed.size() && placed[i].tile == placed[first].tile) ++i;
    count.add(closeTile(std::span(placed).subspan(first, i - first), reach_m));
  }
  return count;
}

}  // namespace vps::bench
