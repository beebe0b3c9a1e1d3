// SPDX-License-Identifier: BSD-3-Clause
#include "proof/clash_groups.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "pair/pair_measures.h"
#include "rules/asked_pairs.h"

namespace vps::scenes {

ClashGroups::ClashGroups(const std::vector<PlacedSurface>& parts, const CheckResult& checked,
                         const std::vector<MovableBody>& bodies)
    : bodies_(bodies), body_of_(bodyOfPart(bodies, parts.size())) {
  std::unordered_map<std::string_view, std::size_t> index_of;
  for (std::size_t i = 0; i < parts.size(); ++i) index_of.emplace(parts[i].name, i);
  double most_m = 0;
  for (const MovableBody& body : bodies_) most_m = std::max(most_m, body.allowed_m);
  std::vector<std::vector<std::pair<std::size_t, const CheckedPair*>>> known(parts.size());
  for (const CheckedPair& pair : checked.pairs) {
    const auto [a, b] = std::minmax(index_of.at(pair.a), index_of.at(pair.b));
    known[a].emplace_back(b, &pair);
  }
  const PairChoice choice = choiceOf(parts, checked);
  for (const auto& [a, b] : nearPairs(parts, 2 * most_m)) {
    NearPair near{a, b};
    if (!choice.has(a, b)) continue;
    if (parts[a].drawn->allow_overlap || parts[b].drawn->allow_overlap) continue;
    for (const auto& [other, pair] : known[a]) {
      if (other != b) continue;
      near.is_uncertain = pair->is_uncertain;
      near.is_clash = pair->isClash();
      near.is_known = pair->isKnown();
      near.drawn_depth_m = pair->interference_depth_m;
      near.allowed_m = near.is_clash ? 0 : pair->interference_depth_m;
    }
    near.error_m =
        meshError_m(parts[a], parts[b]) + std::max(parts[a].drawn->press_fit_m, parts[b].drawn->press_fit_m);
    if (body_of_[a] != body_of_[b])
      pairs_.push_back(near);
    else if (near.is_clash)
      tied_.push_back(near);
  }
}

/// The given bodies and all bodies that pairs for which `joins` is true connect to the given bodies, found
/// breadth first and sorted. A fixed body connects no other bodies.
template <class Joins>
std::vector<std::size_t> ClashGroups::reachable(std::vector<std::size_t> bodies, Joins joins,
                                                std::size_t most) const {
  std::vector<bool> is_in(bodies_.size());
  for (const std::size_t body : bodies) is_in[body] = true;
  for (std::size_t next = 0; next < bodies.size(); ++next) {
    if (bodies_[bodies[next]].is_fixed) continue;
    for (const NearPair& pair : pairs_) {
      const std::size_t a = body_of_[pair.a], b = body_of_[pair.b];
      if ((a != bodies[next] && b != bodies[next]) || !joins(pair)) continue;
      const std::size_t other = a == bodies[next] ? b : a;
      if (is_in[other] || bodies.size() >= most) continue;
      is_in[other] = true;
      bodies.push_back(other);
    }
  }
  std::ranges::sort(bodies);
  return bodies;
}

std::vector<std::vector<std::size_t>> ClashGroups::groups() const {
  std::vector<std::vector<std::size_t>> found;
  std::vector<bool> is_seen(bodies_.size());
  for (const NearPair& pair : pairs_) {
    // Fixed parts do not connect the bodies that clash with them.
    const std::size_t first = body_of_[bodies_[body_of_[pair.a]].is_fixed ? pair.b : pair.a];
    if (!pair.is_clash || is_seen[first]) continue;
    found.push_back(reachable(
        {first}, [](const NearPair& p) { return p.is_clash; }, bodies_.size()));
    for (const std::size_t body : found.back()) is_seen[body] = true;
  }
  return found;
}

bool ClashGroups::isOf(const std::vector<std::size_t>& group, const NearPair& pair) const {
  const std::size_t body = body_of_[bodies_[body_of_[pair.a]].is_fixed ? pair.b : pair.a];
  return pair.is_clash && std::ranges::binary_search(group, body);
}

/// The bodies that may be moved: all that are not fixed, or, if no body is fixed, all but the largest body.
std::vector<std::size_t> ClashGroups::movable(std::vector<std::size_t> bodies) const {
  const std::size_t count = bodies.size();
  std::erase_if(bodies, [&](std::size_t body) { return bodies_[body].is_fixed; });
  if (bodies.size() == count && count > 1)
    bodies.erase(std::ranges::max_element(bodies, {}, [&](std::size_t body) { return size_m(body); }));
  return bodies;
}

std::vector<std::vector<std::size_t>> ClashGroups::tries(const std::vector<std::size_t>& group) const {
  std::vector<std::vector<std::size_t>> out;
  std::vector<std::size_t> by_size = group;
  std::ranges::stable_sort(by_size, {}, [&](std::size_t body) { return size_m(body); });
  const auto isInAll = [&](std::size_t body) {
    return std::ranges::all_of(pairs_, [&](const NearPair& pair) {
      return !isOf(group, pair) || body_of_[pair.a] == body || body_of_[pair.b] == body;
    });
  };
  const auto add = [&](const std::vector<std::size_t>& bodies) {
    if (!bodies.empty() && std::ranges::find(out, bodies) == out.end()) out.push_back(bodies);
  };
  for (const std::size_t body : by_size)
    if (!bodies_[body].is_fixed && isInAll(body)) add({body});
  if (group.size() <= kMostBodies) add(movable(group));
  add(movable(reachable(
      group, [](const NearPair&) { return true; }, std::max(kMostBodies, group.size()))));
  // If two bodies overlap by as much as both tolerances together, both must move.
  std::vector<std::size_t> all = group;
  std::erase_if(all, [&](std::size_t body) { return bodies_[body].is_fixed; });
  add(all);
  std::erase_if(out, [](const auto& bodies) { return bodies.size() > kMostBodies; });
  return out;
}

}  // namespace vps::scenes
