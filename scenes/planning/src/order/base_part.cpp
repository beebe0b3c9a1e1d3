// SPDX-License-Identifier: BSD-3-Clause
#include "order/base_part.h"

#include <algorithm>
#include <cmath>

namespace vps::scenes {

namespace {

double volumeOf(const PlacedSurface& part) {
  const Box& box = part.surface->box();
  if (!part.surface->solid().report().isClosed()) return box.size().prod();
  return std::abs(part.surface->solid().mass().volume_m3);
}

}  // namespace

BasePart proposedBase(const PairMotions& motions, const std::vector<std::size_t>& members) {
  constexpr double kAmongLargest = 0.5;  // assumed: a housing is not much smaller than what it holds
  std::vector<double> volume_m3;
  for (const std::size_t part : members) volume_m3.push_back(volumeOf(motions.parts()[part]));
  const double largest_m3 = *std::ranges::max_element(volume_m3);
  const auto holds = [&](std::size_t part) {
    return std::ranges::count_if(members,
                                 [&](std::size_t m) { return m != part && motions.areNear(m, part); });
  };
  std::size_t best = members.size();
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (volume_m3[i] < kAmongLargest * largest_m3) continue;
    if (best == members.size() ||
        std::pair(holds(members[i]), volume_m3[i]) > std::pair(holds(members[best]), volume_m3[best]))
      best = i;
  }
  const auto held = holds(members[best]);
  std::string reason = volume_m3[best] == largest_m3 ? "the largest part" : "one of the largest parts";
  if (held > 0) reason += ", which touches " + std::to_string(held) + (held == 1 ? " other" : " others");
  return {members[best], std::move(reason)};
}

}  // namespace vps::scenes
