// SPDX-License-Identifier: BSD-3-Clause
#include "solver/point_groups.h"

#include "vps/contact_tolerances.h"

namespace vps::bullet {
namespace {

double leadGap_m(const PenaltyPoint& p) {
  return p.is_leader ? p.gap_m - kSameGap_m : p.gap_m;
}

/// Calls visit(first, end) for each group.
template <typename Visit>
void forEachGroup(const PenaltyPair& pair, int level, const Visit& visit) {
  const std::vector<PenaltyPoint>& points = pair.points;
  for (std::size_t first = 0; first < points.size();) {
    std::size_t end = first + 1;
    if (!pair.is_of_manifold && level > 0)
      while (end < points.size() && points[end].key >> level == points[first].key >> level &&
             points[end].mu == points[first].mu && points[end].n_W.dot(points[first].n_W) > kCosAlike)
        ++end;
    visit(first, end);
    first = end;
  }
}

}  // namespace

void groupPoints(const PenaltyPair& pair, int level, std::vector<PointGroup>& groups) {
  groups.clear();
  forEachGroup(pair, level, [&](std::size_t first, std::size_t end) {
    PointGroup group{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(first),
                     static_cast<std::uint32_t>(end)};
    for (std::size_t i = first; i < end; ++i) {
      group.k_N_per_m += pair.points[i].k_N_per_m;
      group.f_n_N += pair.points[i].f_n_N;
      if (leadGap_m(pair.points[i]) < leadGap_m(pair.points[group.leader]))
        group.leader = static_cast<std::uint32_t>(i);
    }
    groups.push_back(group);
  });
}

int levelFor(std::span<const PenaltyPair* const> pairs, std::size_t limit) {
  if (limit == 0) return 0;
  for (int level = 0; level < kCoarsestLevel; ++level) {
    std::size_t count = 0;
    for (const PenaltyPair* pair : pairs)
      forEachGroup(*pair, level, [&](std::size_t, std::size_t) { ++count; });
    if (count <= limit) return level;
  }
  return kCoarsestLevel;
}

}  // namespace vps::bullet
