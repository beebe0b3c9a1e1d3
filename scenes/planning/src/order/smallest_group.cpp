// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iterator>
#include <set>

#include "order/take_apart.h"
#include "surface/placed_surface.h"

namespace vps::scenes {

namespace {

/// All parts that a part pushes along in a direction, including itself; empty if they include a fixed part,
/// or if there are at least `most` of them.
std::vector<std::size_t> pushedBy(const PairMotions& motions, const std::vector<std::size_t>& remaining,
                                  const std::vector<std::size_t>& fixed, std::size_t part,
                                  std::size_t direction, std::size_t most) {
  std::vector<std::size_t> pushed{part};
  for (std::size_t i = 0; i < pushed.size(); ++i)
    for (const std::size_t held : remaining) {
      if (std::ranges::find(pushed, held) != pushed.end() || !motions.stops(held, pushed[i], direction))
        continue;
      if (std::ranges::binary_search(fixed, held) || pushed.size() + 1 >= most) return {};
      pushed.push_back(held);
    }
  std::ranges::sort(pushed);
  return pushed;
}

}  // namespace

Removal smallestGroup(const PairMotions& motions, const std::vector<std::size_t>& remaining,
                      const std::vector<std::size_t>& fixed, const Progress& progress) {
  const Directions& directions = motions.directions();
  std::vector<std::vector<std::size_t>> of_direction(directions.size());
  forEachOnCores(directions.size(), progress, "", [&](std::size_t d) {
    std::vector<std::size_t>& least = of_direction[d];
    for (const std::size_t part : remaining) {
      if (std::ranges::binary_search(fixed, part)) continue;
      const std::size_t most = least.empty() ? remaining.size() : least.size();
      const std::vector<std::size_t> found = pushedBy(motions, remaining, fixed, part, d, most);
      if (!found.empty()) least = found;
    }
  });
  Removal best;
  const auto isBetter = [&](std::size_t d) {
    if (best.parts.empty()) return true;
    const auto key = [&](std::size_t size, std::size_t of) {
      return std::pair(size, slopeOf(motions, directions[of]));
    };
    return key(of_direction[d].size(), d) < key(best.parts.size(), best.way.direction);
  };
  for (std::size_t d = 0; d < directions.size(); ++d) {
    if (of_direction[d].empty() || !isBetter(d)) continue;
    best.parts = of_direction[d];
    best.way = {WayKind::Straight, {{{directions[d], Vec3::Zero(), false}, motions.leave_m()}}, d, 0};
  }
  return best;
}

std::vector<std::vector<std::size_t>> connectedGroups(const PairMotions& motions,
                                                      const std::vector<std::size_t>& remaining,
                                                      const std::vector<std::size_t>& fixed) {
  std::vector<std::size_t> movable;
  std::ranges::set_difference(remaining, fixed, std::back_inserter(movable));
  std::vector<std::vector<std::size_t>> groups, larger;
  for (const std::size_t part : movable) larger.push_back({part});
  while (!larger.empty() && groups.size() < kMostGroups) {
    std::set<std::vector<std::size_t>> found;  // sets of parts, each sorted by part
    for (const std::vector<std::size_t>& group : larger)
      for (const std::size_t part : movable) {
        if (found.size() + groups.size() >= kMostGroups) break;
        const bool is_member = std::ranges::binary_search(group, part);
        if (is_member || std::ranges::none_of(group, [&](std::size_t p) { return motions.areNear(p, part); }))
          continue;
        std::vector<std::size_t> with = group;
        with.insert(std::ranges::upper_bound(with, part), part);
        found.insert(std::move(with));
      }
    larger.assign(found.begin(), found.end());
    groups.insert(groups.end(), larger.begin(), larger.end());
  }
  return groups;
}

}  // namespace vps::scenes
