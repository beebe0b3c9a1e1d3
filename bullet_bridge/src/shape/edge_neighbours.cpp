// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/edge_neighbours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace vps::bullet::inline v0 {

namespace {

constexpr double kReach = 1.5;    // of the spacing
constexpr std::size_t kMost = 8;  // assumed: two along the edge, and as many on three edges beside it

using Cell = std::array<std::int64_t, 3>;

/// Points sorted by cells of a grid.
class Grid {
 public:
  Grid(const std::vector<Vec3>& points, std::span<const std::uint8_t> on_edge, double cell_m)
      : points_(points), cell_m_(cell_m) {
    for (std::uint32_t i = 0; i < on_edge.size(); ++i)
      if (on_edge[i] != 0) sorted_.push_back({cellOf(i), i});
    std::sort(sorted_.begin(), sorted_.end());
  }
  template <typename Visit>
  void forEachAround(std::uint32_t id, const Visit& visit) const {
    const Cell middle = cellOf(id);
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy) {
        // Cells that differ in z alone are one range.
        const Entry low{{middle[0] + dx, middle[1] + dy, middle[2] - 1}, 0};
        for (auto at = std::lower_bound(sorted_.begin(), sorted_.end(), low);
             at != sorted_.end() && at->first[0] == low.first[0] && at->first[1] == low.first[1] &&
             at->first[2] <= middle[2] + 1;
             ++at)
          visit(at->second);
      }
  }

 private:
  using Entry = std::pair<Cell, std::uint32_t>;
  [[nodiscard]] Cell cellOf(std::uint32_t id) const {
    Cell cell;
    for (int k = 0; k < 3; ++k)
      cell[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor(points_[id][k] / cell_m_));
    return cell;
  }

  const std::vector<Vec3>& points_;
  double cell_m_;
  std::vector<Entry> sorted_;
};

}  // namespace

EdgeNeighbours::EdgeNeighbours(const PointShell& shell, std::span<const std::uint8_t> on_edge) {
  if (on_edge.empty() || !(shell.spacing_m > 0)) return;
  const double reach_m = kReach * shell.spacing_m;
  const Grid grid(shell.points, on_edge, reach_m);
  std::vector<std::pair<double, std::uint32_t>> near;
  first_.push_back(0);
  for (std::uint32_t i = 0; i < on_edge.size(); ++i) {
    near.clear();
    if (on_edge[i] != 0)
      grid.forEachAround(i, [&](std::uint32_t other) {
        const double distance_m = (shell.points[other] - shell.points[i]).norm();
        if (other != i && distance_m <= reach_m) near.push_back({distance_m, other});
      });
    std::sort(near.begin(), near.end());
    if (near.size() > kMost) near.resize(kMost);
    for (const auto& [distance_m, other] : near) ids_.push_back(other);
    first_.push_back(static_cast<std::uint32_t>(ids_.size()));
  }
}

}  // namespace vps::bullet::inline v0
