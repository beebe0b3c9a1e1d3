// SPDX-License-Identifier: BSD-3-Clause
// Groups that leave by a path of one of their parts: the part, and all parts that it takes along.
#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "order/take_apart.h"
#include "surface/placed_surface.h"

namespace vps::scenes {

namespace {

using Parts = std::vector<std::size_t>;

/// All parts that a part pushes along on its path, including itself; empty if they include one of the parts
/// that stay.
/// @param passed  parts that the part passes on its path, which need not be searched again
Parts takenAlong(const PairMotions& motions, const Parts& remaining, const Parts& staying, std::size_t part,
                 const Way& way, const Parts& passed) {
  Parts taken{part};
  const auto isIn = [](const Parts& parts, std::size_t one) {
    return std::ranges::find(parts, one) != parts.end();
  };
  for (std::size_t i = 0; i < taken.size(); ++i)
    for (const std::size_t held : remaining) {
      if (isIn(taken, held) || (i == 0 && isIn(passed, held)) || !stopsWay(motions, held, taken[i], way))
        continue;
      if (isIn(staying, held)) return {};
      taken.push_back(held);
    }
  std::ranges::sort(taken);
  return taken;
}

/// The first of the smallest groups of all parts; `groupOf(part)` gives the group of one part.
template <class GroupOf>
Removal smallestOf(const Parts& parts, const Progress& progress, GroupOf groupOf) {
  std::vector<Removal> found(parts.size());
  forEachOnCores(parts.size(), progress, "", [&](std::size_t i) { found[i] = groupOf(parts[i]); });
  Removal best;
  const auto key = [](const Removal& one) { return std::pair(one.parts.size(), one.way.legs.size()); };
  for (Removal& one : found)
    if (one.parts.size() > 1 && (best.parts.empty() || key(one) < key(best))) best = std::move(one);
  return best;
}

Parts movableOf(const Parts& remaining, const Parts& fixed) {
  Parts movable;
  std::ranges::set_difference(remaining, fixed, std::back_inserter(movable));
  return movable;
}

}  // namespace

Removal screwedGroup(const PairMotions& motions, const Parts& remaining, const Parts& fixed,
                     const Progress& progress) {
  return smallestOf(movableOf(remaining, fixed), progress, [&](std::size_t part) {
    Removal best;
    for (std::size_t i = 0; i < motions.fitsOf(part).size(); ++i) {
      const std::size_t mate = motions.matesOf(part)[i];
      if (motions.fitsOf(part)[i].kind != FitKind::Thread || !std::ranges::binary_search(remaining, mate))
        continue;
      std::optional<Way> way = screwWay(motions, part, {mate});
      if (!way) continue;
      Parts staying = fixed;
      staying.push_back(mate);
      Parts taken = takenAlong(motions, remaining, staying, part, *way, {mate});
      if (taken.empty() || (!best.parts.empty() && best.parts.size() <= taken.size())) continue;
      best = {std::move(taken), std::move(*way), false, {}};
    }
    return best;
  });
}

Removal groupAlongLegs(const PairMotions& motions, const Parts& remaining, const Parts& fixed,
                       GroupSeeds seeds, std::vector<SearchWork>& work, const Progress& progress) {
  return smallestOf(movableOf(remaining, fixed), progress, [&](std::size_t part) {
    if (seeds == GroupSeeds::OnRoundFits &&
        std::ranges::none_of(motions.fitsOf(part),
                             [](const CheckedFit& f) { return f.kind == FitKind::Shaft; }))
      return Removal{};
    // Parts that touch the part may go with it; at the second try, so may all parts that are not fixed.
    Parts apart;
    for (const std::size_t other : remaining)
      if (other != part && (std::ranges::binary_search(fixed, other) || !motions.areNear(other, part)))
        apart.push_back(other);
    for (const Parts& held : {apart, fixed}) {
      std::optional<Way> way = legWay(motions, {part}, held, work[part]);
      if (!way) continue;
      Parts taken = takenAlong(motions, remaining, fixed, part, *way, held);
      if (!taken.empty()) return Removal{std::move(taken), std::move(*way), false, {}};
      if (apart == fixed) break;
    }
    return Removal{};
  });
}

}  // namespace vps::scenes
