// SPDX-License-Identifier: BSD-3-Clause
#include "order/take_apart.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "surface/placed_surface.h"

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

namespace {

std::vector<std::size_t> without(const std::vector<std::size_t>& all, const std::vector<std::size_t>& some) {
  std::vector<std::size_t> out;
  std::ranges::set_difference(all, some, std::back_inserter(out));
  return out;
}

class TakingApart {
 public:
  TakingApart(const PairMotions& motions, std::vector<std::size_t> members, std::vector<std::size_t> fixed,
              const Progress& progress, const std::function<void(const Removal&)>& on_removal)
      : motions_(motions), remaining_(std::move(members)), fixed_(std::move(fixed)), on_removal_(on_removal) {
    std::ranges::sort(remaining_);
    std::ranges::sort(fixed_);
    stopped_by_.resize(motions.parts().size());
    screws_.resize(motions.parts().size());
    legs_.resize(motions.parts().size());
    by_contact_.resize(motions.parts().size());
    if (!progress) return;
    // A single search has no known end: its progress only reports activity, and lets the caller cancel.
    const auto count = static_cast<double>(remaining_.size() - fixed_.size());
    progress_ = [this, count, &progress](std::string_view, double) {
      progress("taking apart", 1 - static_cast<double>(remaining_.size() - fixed_.size()) / count);
    };
  }

  Disassembly run() {
    Disassembly out{fixed_, {}, {}};
    while (remaining_.size() > fixed_.size()) {
      Removal removal = next();
      if (removal.parts.empty()) break;
      remaining_ = without(remaining_, removal.parts);
      last_ = removal.way.direction;
      if (on_removal_) on_removal_(removal);
      out.removals.push_back(std::move(removal));
    }
    for (const std::size_t part : without(remaining_, fixed_)) out.blocked.push_back(blockedOf(part));
    return out;
  }

 private:
  using Score = std::tuple<std::size_t, int, int, int, int, double, double, std::size_t>;

  Removal next() {
    if (Removal found = straight(); !found.parts.empty() && found.falling.empty()) return found;
    if (Removal found = alone([&](std::size_t part) { return screwOf(part); }); !found.parts.empty())
      return found;
    if (Removal found = straight(); !found.parts.empty()) return found;
    if (Removal found = smallestGroup(motions_, remaining_, fixed_, progress_); !found.parts.empty())
      return completed(std::move(found));
    if (Removal found = screwedGroup(motions_, remaining_, fixed_, progress_); !found.parts.empty())
      return completed(std::move(found));
    return byLegs();
  }

  /// Searches paths of several legs. The work limits do not depend on the machine: about five seconds for
  /// each part, and a minute in all.
  Removal byLegs() {
    const std::size_t parts = remaining_.size() - fixed_.size();
    const std::uint64_t share = shareOfWork(parts);
    Removal found = alone([&](std::size_t part) {
      legs_[part] = {share, 0};
      return legWay(motions_, {part}, without(remaining_, {part}), legs_[part]);
    });
    for (const std::size_t part : without(remaining_, fixed_)) work_of_legs_ += legs_[part].done;
    if (found.parts.empty()) found = groupAlong(GroupSeeds::OnRoundFits);
    if (found.parts.empty()) found = byContact();
    return found.parts.empty() ? groupByLegs() : found;
  }

  /// A part on a path of several legs, with the parts that it takes along.
  Removal groupAlong(GroupSeeds seeds) {
    const std::size_t parts = remaining_.size() - fixed_.size();
    if (parts < 2) return {};
    constexpr std::uint64_t kOfAll = 20'000'000;
    const std::uint64_t left = kOfAll - std::min(kOfAll, work_along_);
    std::vector<SearchWork> work(motions_.parts().size(), {left / parts, 0});
    Removal found = groupAlongLegs(motions_, remaining_, fixed_, seeds, work, progress_);
    for (const SearchWork& one : work) work_along_ += one.done;
    return found.parts.empty() ? found : completed(std::move(found));
  }

  /// Searches paths that contacts suggest, for parts that no path along axes leads out. A place has three
  /// times the motions, so that the limits are twice those of byLegs().
  Removal byContact() {
    constexpr std::uint64_t kOfPart = 4'000'000, kOfAll = 80'000'000;
    const std::uint64_t left = kOfAll - std::min(kOfAll, work_by_contact_);
    const std::uint64_t share = std::min(kOfPart, left / (remaining_.size() - fixed_.size()));
    Removal found = alone([&](std::size_t part) {
      by_contact_[part] = {share, 0};
      return contactWay(motions_, part, without(remaining_, {part}), by_contact_[part]);
    });
    for (const std::size_t part : without(remaining_, fixed_)) work_by_contact_ += by_contact_[part].done;
    return found;
  }

  /// The first of the smallest sets that has a path; then a set along the path of one part.
  Removal groupByLegs() {
    const std::vector<std::vector<std::size_t>> groups = connectedGroups(motions_, remaining_, fixed_);
    const std::uint64_t share = shareOfWork(groups.size());
    for (auto first = groups.begin(); first != groups.end();) {
      const auto end = std::ranges::find_if(first, groups.end(),
                                            [&](const auto& group) { return group.size() > first->size(); });
      const auto count = static_cast<std::size_t>(end - first);
      std::vector<std::optional<Way>> ways(count);
      std::vector<SearchWork> work(count, SearchWork{share, 0});
      forEachOnCores(count, progress_, "", [&](std::size_t i) {
        const std::vector<std::size_t>& group = first[static_cast<std::ptrdiff_t>(i)];
        ways[i] = legWay(motions_, group, without(remaining_, group), work[i]);
      });
      for (const SearchWork& one : work) work_of_legs_ += one.done;
      for (std::size_t i = 0; i < count; ++i)
        if (ways[i])
          return completed({first[static_cast<std::ptrdiff_t>(i)], std::move(*ways[i]), false, {}});
      first = end;
    }
    // Larger sets than were tried may leave along the path of one of their parts.
    return groups.size() < kMostGroups ? Removal{} : groupAlong(GroupSeeds::All);
  }

  [[nodiscard]] std::uint64_t shareOfWork(std::size_t searches) const {
    constexpr std::uint64_t kOfPart = 2'000'000, kOfAll = 40'000'000;
    const std::uint64_t left = kOfAll - std::min(kOfAll, work_of_legs_);
    return std::min(kOfPart, left / std::max<std::size_t>(1, searches));
  }

  Removal straight() {
    return alone([&](std::size_t part) { return straightWay(part); });
  }

  /// The removal with the best score, of all parts that have a path when they move alone.
  template <class WayOf>
  Removal alone(WayOf wayOf) {
    const std::vector<std::size_t> parts = without(remaining_, fixed_);
    std::vector<std::optional<Way>> ways(parts.size());
    forEachOnCores(parts.size(), progress_, "", [&](std::size_t i) { ways[i] = wayOf(parts[i]); });
    Removal best;
    Score least;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (!ways[i]) continue;
      Removal one = completed({{parts[i]}, std::move(*ways[i]), false, {}});
      const Score score = scoreOf(one);
      if (!best.parts.empty() && least <= score) continue;
      best = std::move(one);
      least = score;
    }
    return best;
  }

  /// The best direction in which a part passes all remaining parts; likely directions are tried first. A
  /// direction that needs an allowance for overlapping facets, such as a hole that is a little too small, is
  /// used only if no other direction is free.
  std::optional<Way> straightWay(std::size_t part) {
    std::optional<Way> last_resort;
    for (std::vector<std::size_t> directions : {motions_.axesOf(part), motions_.around()}) {
      std::ranges::stable_sort(directions, {}, [&](std::size_t d) { return rank(part, d); });
      for (const std::size_t d : directions) {
        if (!leaves(part, d)) continue;
        const Motion motion{motions_.directions()[d], Vec3::Zero(), false};
        Way way{WayKind::Straight, {{motion, motions_.leave_m()}}, d, 0, allowanceOf(part, d)};
        if (way.allowance_m == 0) return way;
        if (!last_resort) last_resort = std::move(way);
      }
    }
    return last_resort;
  }

  /// Greatest allowance that the part needs to pass one of the remaining parts.
  [[nodiscard]] double allowanceOf(std::size_t part, std::size_t direction) const {
    double most_m = 0;
    for (const std::size_t held : remaining_)
      if (held != part) most_m = std::max(most_m, motions_.allowanceOf(held, part, direction));
    return most_m;
  }

  [[nodiscard]] std::pair<int, int> rank(std::size_t part, std::size_t d) const {
    return {slopeOfPart(part, motions_.directions()[d]), last_ == d ? 0 : 1};
  }

  /// Sort key of a direction, as slopeOf(), but a part that has a round fit, even with a part that has
  /// already left, prefers directions along this fit to directions across it: a nut leaves along its bolt.
  [[nodiscard]] int slopeOfPart(std::size_t part, const Vec3& direction_W) const {
    constexpr int kUp = 0, kAlongFit = 1, kMore = 2;
    const int slope = slopeOf(motions_, direction_W);
    if (slope == 0) return kUp;
    const bool is_along = std::ranges::any_of(motions_.fitsOf(part), [&](const CheckedFit& fit) {
      return fit.kind != FitKind::Key && fit.axis_W.cross(direction_W).norm() < 1e-3;
    });
    return is_along ? kAlongFit : slope + kMore;
  }

  /// Tests first the part that stopped the motion in the last test. A direction that was free stays free,
  /// since the remaining parts only become fewer.
  bool leaves(std::size_t part, std::size_t direction) {
    const auto [known, is_new] = stopped_by_[part].try_emplace(direction, part);
    std::size_t& by = known->second;
    if (!is_new && (by == part || std::ranges::binary_search(remaining_, by))) return by == part;
    for (const std::size_t held : remaining_) {
      if (held == part || !motions_.stops(held, part, direction)) continue;
      by = held;
      return false;
    }
    by = part;
    return true;
  }

  /// Searches again only if a part has left since the last search, because that part may have blocked the
  /// screw.
  std::optional<Way> screwOf(std::size_t part) {
    Screw& known = screws_[part];
    if (known.is_known && (known.way || known.among == remaining_.size())) return known.way;
    known = {true, remaining_.size(), screwWay(motions_, part, without(remaining_, {part}))};
    return known.way;
  }

  [[nodiscard]] Removal completed(Removal removal) const {
    const auto isIn = [](const std::vector<std::size_t>& parts, std::size_t part) {
      return std::ranges::binary_search(parts, part);
    };
    const auto isCarried = [&](std::size_t part) {  // whether a part that stays carries this part
      return std::ranges::any_of(motions_.carriersOf(part), [&](std::size_t carrier) {
        return isIn(remaining_, carrier) && !isIn(removal.parts, carrier);
      });
    };
    removal.is_carried = std::ranges::any_of(removal.parts, isCarried);
    std::set<std::size_t> falling;
    for (const std::size_t part : removal.parts)
      for (const std::size_t carried : motions_.carriedBy(part))
        if (isIn(remaining_, carried) && !isIn(removal.parts, carried) && !isIn(fixed_, carried) &&
            !isCarried(carried))
          falling.insert(carried);
    removal.falling.assign(falling.begin(), falling.end());
    return removal;
  }

  [[nodiscard]] Score scoreOf(const Removal& removal) const {
    const Box& box = motions_.parts()[removal.parts.front()].box_W;
    const double height_m = motions_.directions()[motions_.up()].dot(box.center());
    return {removal.falling.size(),
            removal.way.allowance_m > 0 ? 1 : 0,
            static_cast<int>(removal.way.kind),
            slopeOfPart(removal.parts.front(), removal.way.legs.back().motion.direction),
            last_ == removal.way.direction ? 0 : 1,
            -loosenessOf(removal.parts.front()),
            -height_m,
            removal.parts.front()};
  }

  /// Clearance of the part's tightest fit with a remaining part, rounded to a micrometre; infinite without
  /// such a fit.
  [[nodiscard]] double loosenessOf(std::size_t part) const {
    double least_m = std::numeric_limits<double>::infinity();
    const std::vector<CheckedFit>& fits = motions_.fitsOf(part);
    for (std::size_t i = 0; i < fits.size(); ++i)
      if (std::ranges::binary_search(remaining_, motions_.matesOf(part)[i]))
        least_m = std::min(least_m, std::round(1e6 * fits[i].diametral_clearance_m) * 1e-6);
    return least_m;
  }

  [[nodiscard]] Disassembly::Blocked blockedOf(std::size_t part) const {
    Disassembly::Blocked blocked{part, {}, !legs_[part].isSpent() && !by_contact_[part].isSpent()};
    // Only blocking parts that touch this part are reported; if no blocking part touches it, as for a link in
    // a chain, all blocking parts are reported.
    for (const bool has_to_meet : {true, false}) {
      for (const std::size_t held : remaining_) {
        if (held == part || (has_to_meet && !motions_.areNear(held, part))) continue;
        if (std::ranges::any_of(motions_.axesOf(part),
                                [&](std::size_t d) { return motions_.stops(held, part, d); }))
          blocked.by.push_back(held);
      }
      if (!blocked.by.empty()) return blocked;
    }
    return blocked;
  }

  struct Screw {
    bool is_known = false;
    std::size_t among = 0;  ///< number of remaining parts when the search was made
    std::optional<Way> way;
  };
  const PairMotions& motions_;
  std::vector<std::size_t> remaining_, fixed_;
  /// By part and direction: the part that stopped the motion last; the part itself if nothing stopped it.
  std::vector<std::map<std::size_t, std::size_t>> stopped_by_;
  std::vector<Screw> screws_;
  std::vector<SearchWork> legs_;  ///< by part: the work of the last search for legs of the part
  std::uint64_t work_of_legs_ = 0;
  std::vector<SearchWork> by_contact_;  ///< by part: the work of the last search by contacts
  std::uint64_t work_by_contact_ = 0;
  std::uint64_t work_along_ = 0;  ///< of groupAlong()
  const std::function<void(const Removal&)>& on_removal_;
  Progress progress_;
  std::size_t last_ = 0;
};

}  // namespace

int slopeOf(const PairMotions& motions, const Vec3& direction_W) {
  const double rise = motions.directions()[motions.up()].dot(direction_W);
  constexpr double kSideways = 1e-3;
  if (rise > 1 - kSideways) return 0;
  return rise > -kSideways ? 1 : 2;
}

Disassembly takeApart(const PairMotions& motions, const std::vector<std::size_t>& members,
                      const std::vector<std::size_t>& fixed, const Progress& progress,
                      const std::function<void(const Removal&)>& on_removal) {
  return TakingApart(motions, members, fixed, progress, on_removal).run();
}

}  // namespace vps::scenes
