// SPDX-License-Identifier: BSD-3-Clause
// The order in which parts leave an assembly.
#pragma once

#include <functional>
#include <vector>

#include "ways/way.h"

namespace vps::scenes {

/// One part, or several that leave as one.
struct Removal {
  std::vector<std::size_t> parts;  ///< ascending
  Way way;
  bool is_carried = false;
  std::vector<std::size_t> falling;  ///< what stays and loses the last part that carried it
};

struct Disassembly {
  std::vector<std::size_t> fixed;
  std::vector<Removal> removals;
  struct Blocked {
    std::size_t part;
    std::vector<std::size_t> by;
    bool is_searched = true;  ///< false: the search of legs ended at its limit of work
  };
  std::vector<Blocked> blocked;
};

/// Takes parts off the fixed ones, one after the other, by rules in this order: what makes nothing fall;
/// what needs no allowance for meshes; straight before screws; upwards, along round fits, sideways, down; in
/// the direction of the one before; the loosest fit, so that pins are in place before what they locate; the
/// highest; the first. Where no part leaves alone, the smallest set that leaves straight as one does; where
/// none does, ways of several legs are searched, of parts alone and then of sets, with limits of work for
/// each and for all. What is left in the end is blocked. On all cores.
/// @param on_removal  hears of each as it is found
Disassembly takeApart(const PairMotions& motions, const std::vector<std::size_t>& members,
                      const std::vector<std::size_t>& fixed, const Progress& progress,
                      const std::function<void(const Removal&)>& on_removal = {});

/// The smallest set of parts without a fixed one that leaves straight, with its direction: for each part and
/// direction all that it would push along, of which it needs the least. Empty if there is none.
Removal smallestGroup(const PairMotions& motions, const std::vector<std::size_t>& remaining,
                      const std::vector<std::size_t>& fixed, const Progress& progress);

/// Sets of parts without a fixed one, each connected by pairs that are near each other: the smaller first,
/// and all of those of two or more parts, but 256 at most.
std::vector<std::vector<std::size_t>> connectedGroups(const PairMotions& motions,
                                                      const std::vector<std::size_t>& remaining,
                                                      const std::vector<std::size_t>& fixed);

/// Sort key of directions: up, sideways, down.
int slopeOf(const PairMotions& motions, const Vec3& direction_W);

}  // namespace vps::scenes
