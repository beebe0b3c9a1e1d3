// SPDX-License-Identifier: BSD-3-Clause
#include "overlaps/drawn_overlaps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "vps/box.h"

namespace vps::scenes {

namespace {

using Cell = std::array<std::int32_t, 3>;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// The grid cells that the surface intersects, in ascending order, with their neighbourhoods.
class SurfaceCells {
 public:
  SurfaceCells(const Mesh& mesh, double cell_m) {
    const Vec3 origin = bounds(mesh).min;
    for (const auto& triangle : mesh.triangles) {
      const Vec3 &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]],
                 &c = mesh.vertices[triangle[2]];
      const double longest_m = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
      // Points every three quarters of a cell leave no gap between the cells.
      const int rows = std::max(1, static_cast<int>(std::ceil(longest_m / (0.75 * cell_m))));
      // A sliver needs few rows of points across its width.
      const double across_m = (b - a).cross(c - a).norm() / std::max(longest_m, 1e-300);
      appendPoints(longestFirst(a, b, c), rows,
                   std::max(1, static_cast<int>(std::ceil(across_m / (0.75 * cell_m)))), origin, cell_m);
    }
    sortCells();
  }

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(cells_.size()); }
  [[nodiscard]] const Cell& operator[](std::uint32_t i) const { return cells_[i]; }

  /// Calls visit(cell, distance in cells) for those of the 26 neighbours that the surface intersects.
  template <class Visit>
  void forNeighbours(std::uint32_t i, const Visit& visit) const {
    for (int k = 0; k < 27; ++k) {
      const Cell step = {k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1};
      if (k == 13) continue;
      const Cell& at = cells_[i];
      const std::uint32_t to = find({at[0] + step[0], at[1] + step[1], at[2] + step[2]});
      if (to != kNone)
        visit(to, std::sqrt(double(step[0] * step[0] + step[1] * step[1] + step[2] * step[2])));
    }
  }

 private:
  /// The triangle's corners, starting with the longest side.
  static std::array<Vec3, 3> longestFirst(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double ab = (b - a).norm(), bc = (c - b).norm(), ca = (a - c).norm();
    if (ab >= bc && ab >= ca) return {a, b, c};
    return bc >= ca ? std::array<Vec3, 3>{b, c, a} : std::array<Vec3, 3>{c, a, b};
  }
  void appendPoints(const std::array<Vec3, 3>& t, int along, int across, const Vec3& origin, double cell_m) {
    for (int i = 0; i <= across; ++i) {
      const double up = static_cast<double>(i) / across;
      const Vec3 from = t[0] + up * (t[2] - t[0]), to = t[1] + up * (t[2] - t[1]);
      const int pieces = std::max(1, static_cast<int>(std::ceil((1 - up) * along)));
      for (int k = 0; k <= pieces; ++k) {
        const Vec3 p = (from + (static_cast<double>(k) / pieces) * (to - from) - origin) / cell_m;
        const Cell cell = {static_cast<std::int32_t>(std::floor(p.x())),
                           static_cast<std::int32_t>(std::floor(p.y())),
                           static_cast<std::int32_t>(std::floor(p.z()))};
        if (cells_.empty() || cells_.back() != cell) cells_.push_back(cell);
      }
    }
    constexpr std::size_t kMost = 4'000'000;  // number of cells at which duplicates are dropped
    if (cells_.size() > kMost + 2 * kept_) {
      sortCells();
      kept_ = cells_.size();
    }
  }
  void sortCells() {
    std::ranges::sort(cells_);
    cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
  }
  [[nodiscard]] std::uint32_t find(const Cell& cell) const {
    const auto at = std::ranges::lower_bound(cells_, cell);
    return at != cells_.end() && *at == cell ? static_cast<std::uint32_t>(at - cells_.begin()) : kNone;
  }

  std::vector<Cell> cells_;
  std::size_t kept_ = 0;
};

/// Distances from one cell along the surface, in cells; infinite for cells that are not connected to that
/// cell.
std::vector<double> distancesFrom(const SurfaceCells& cells, std::uint32_t start) {
  std::vector<double> distance(cells.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  distance[start] = 0;
  open.emplace(0, start);
  while (!open.empty()) {
    const auto [d, i] = open.top();
    open.pop();
    if (d > distance[i]) continue;
    cells.forNeighbours(i, [&](std::uint32_t k, double step) {
      if (d + step >= distance[k]) return;
      distance[k] = d + step;
      open.emplace(distance[k], k);
    });
  }
  return distance;
}

std::uint32_t farthest(const std::vector<double>& distance) {
  std::uint32_t out = 0;
  for (std::uint32_t i = 1; i < distance.size(); ++i)
    if (std::isfinite(distance[i]) && (!std::isfinite(distance[out]) || distance[i] > distance[out])) out = i;
  return out;
}

}  // namespace

WireMeasure measureWire(const Mesh& mesh) {
  constexpr double kMostCells = 50'000, kBand = 3;
  WireMeasure out;
  const double area_m2 = area(mesh), volume_m3 = std::abs(massProperties(mesh).volume_m3);
  if (!(area_m2 > 0) || !(volume_m3 > 0)) return out;
  const double cell_m = std::max(volume_m3 / area_m2, std::sqrt(area_m2 / kMostCells));
  const SurfaceCells cells(mesh, cell_m);
  const std::vector<double> distance = distancesFrom(cells, farthest(distancesFrom(cells, 0)));

  const auto bandOf = [&](std::uint32_t i) { return static_cast<std::size_t>(distance[i] / kBand); };
  std::vector<std::size_t> counts;
  std::vector<bool> is_seen(cells.size(), false);
  std::vector<std::uint32_t> open;
  double widths = 0, sections = 0;
  for (std::uint32_t first = 0; first < cells.size(); ++first) {
    if (is_seen[first] || !std::isfinite(distance[first])) continue;
    const std::size_t band = bandOf(first);
    Box box;
    open = {first};
    is_seen[first] = true;
    while (!open.empty()) {
      const std::uint32_t i = open.back();
      open.pop_back();
      box.add(Vec3(cells[i][0], cells[i][1], cells[i][2]));
      cells.forNeighbours(i, [&](std::uint32_t k, double) {
        if (is_seen[k] || bandOf(k) != band) return;
        is_seen[k] = true;
        open.push_back(k);
      });
    }
    counts.resize(std::max(counts.size(), band + 1));
    ++counts[band];
    widths += box.size().norm();
    ++sections;
  }
  out.length_m = sections * kBand * cell_m;
  out.width_m = widths / sections * cell_m;
  std::ranges::sort(counts);
  out.bands = static_cast<double>(counts[counts.size() * 19 / 20]);
  return out;
}

bool isWireLike(const Mesh& mesh) {
  constexpr double kLeastSlender = 15, kMostBands = 2;  // assumed
  const WireMeasure wire = measureWire(mesh);
  return wire.bands <= kMostBands && wire.slenderness() >= kLeastSlender;
}

}  // namespace vps::scenes
