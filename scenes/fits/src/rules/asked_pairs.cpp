// SPDX-License-Identifier: BSD-3-Clause
#include "rules/asked_pairs.h"

#include <algorithm>
#include <map>

#include "pair/pair_measures.h"

namespace vps::scenes {

namespace {

std::vector<PartNames> namesOfPlaced(const std::vector<PlacedSurface>& parts) {
  std::vector<PartNames> out;
  for (const PlacedSurface& part : parts) out.push_back({part.name, part.drawn->within});
  return out;
}

}  // namespace

AskedPairs askedPairs(const std::vector<PlacedSurface>& parts, const CheckSettings& settings) {
  const std::vector<PartNames> names = namesOfPlaced(parts);
  const PairChoice choice(settings.between, settings.ignored, names);
  const auto isAsked = [&](std::size_t a, std::size_t b) {
    return settings.isAsked(parts[a].name) || settings.isAsked(parts[b].name);
  };
  AskedPairs out;
  std::map<std::pair<std::size_t, std::size_t>, double> near_m;
  for (const auto& [a, b] : nearPairs(parts, settings.near_m)) {
    if (!isAsked(a, b)) continue;
    if (choice.has(a, b))
      near_m[{a, b}] = settings.near_m;
    else
      out.left_out.push_back(choice.leftOut(a, b));
  }
  std::vector<double> error_m;
  for (const CheckRule& rule : settings.rules) {
    const MatchedPairs of = rule.between ? MatchedPairs(*rule.between, names) : MatchedPairs::all(names);
    if (!rule.min_clearance_m) continue;
    if (error_m.empty())
      for (const PlacedSurface& part : parts) error_m.push_back(faceError_m(part));
    // The box of a mesh may be smaller than the box of the true faces by the mesh's error.
    const double most_m = *rule.min_clearance_m + 2 * *std::ranges::max_element(error_m);
    for (const auto& [a, b] : nearPairs(parts, most_m)) {
      const double reach_m = *rule.min_clearance_m + error_m[a] + error_m[b];
      if (!isAsked(a, b) || !of.has(a, b) || !choice.has(a, b) ||
          distance2(parts[a].box_W, parts[b].box_W) > reach_m * reach_m)
        continue;
      double& reported_m = near_m.try_emplace({a, b}, settings.near_m).first->second;
      reported_m = std::max(reported_m, *rule.min_clearance_m);
    }
  }
  for (const auto& [pair, up_to_m] : near_m) {
    out.pairs.push_back(pair);
    out.near_m.push_back(up_to_m);
  }
  return out;
}

PairChoice choiceOf(const std::vector<PlacedSurface>& parts, const CheckResult& result) {
  return {result.between, result.ignored, namesOfPlaced(parts)};
}

}  // namespace vps::scenes
