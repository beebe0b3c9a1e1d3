// SPDX-License-Identifier: BSD-3-Clause
#include "order/take_apart.h"

#include <algorithm>
#include <map>
#include <set>

#include "surface/placed_surface.h"

namespace vps::scenes {

std::vector<PlannedOrder> precedence(const PairMotions& motions, const Disassembly& apart,
                                     const std::vector<std::string>& names) {
  // Orders by index of removal: a part that was removed earlier is mounted later.
  std::vector<std::vector<PlannedOrder>> found(apart.removals.size());
  const auto isAny = [](const Removal& a, const Removal& b, auto is) {
    return std::ranges::any_of(a.parts, [&](std::size_t i) {
      return std::ranges::any_of(b.parts, [&](std::size_t k) { return is(i, k); });
    });
  };
  forEachOnCores(apart.removals.size(), {}, "", [&](std::size_t i) {
    const Removal& part = apart.removals[i];
    for (std::size_t k = 0; k < i; ++k) {
      const Removal& later = apart.removals[k];
      const bool is_in_way = isAny(part, later, [&](std::size_t moving, std::size_t held) {
        return stopsWay(motions, held, moving, part.way);
      });
      const bool is_carrying = isAny(part, later, [&](std::size_t under, std::size_t over) {
        return std::ranges::binary_search(motions.carriedBy(under), over);
      });
      if (is_in_way)
        found[i].push_back({names[i], names[k], OrderReason::Way});
      else if (is_carrying)
        found[i].push_back({names[i], names[k], OrderReason::Carries});
    }
  });
  std::vector<PlannedOrder> out;
  for (std::size_t i = found.size(); i-- > 0;) {
    std::ranges::reverse(found[i]);
    out.insert(out.end(), found[i].begin(), found[i].end());
  }
  return out;
}

std::vector<PlannedOrder> reducedOrder(const std::vector<PlannedOrder>& order) {
  std::map<std::string, std::set<std::string>> after;
  for (const PlannedOrder& one : order) after[one.before].insert(one.after);
  std::vector<PlannedOrder> out;
  for (const PlannedOrder& one : order) {
    // Search for a chain of other steps that leads from one.before to one.after.
    std::vector<std::string> waiting;
    std::set<std::string> seen;
    for (const std::string& next : after[one.before])
      if (next != one.after && seen.insert(next).second) waiting.push_back(next);
    bool follows = false;
    while (!waiting.empty() && !follows) {
      const std::string here = waiting.back();
      waiting.pop_back();
      for (const std::string& next : after[here]) {
        if (next == one.after) follows = true;
        if (seen.insert(next).second) waiting.push_back(next);
      }
    }
    if (!follows) out.push_back(one);
  }
  return out;
}

}  // namespace vps::scenes
