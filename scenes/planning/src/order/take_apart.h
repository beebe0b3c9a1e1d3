// SPDX-License-Identifier: BSD-3-Clause
// The order in which parts leave an assembly: base part, removals, precedence.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ways/pair_motions.h"
#include "ways/way.h"

namespace vps::scenes {

/// One part that leaves, or several parts that leave as one.
struct Removal {
  std::vector<std::size_t> parts;  ///< ascending
  Way way;
  bool is_carried = false;
  std::vector<std::size_t> falling;  ///< parts that stay and lose the last part that carried them
};

struct Disassembly {
  std::vector<std::size_t> fixed;
  std::vector<Removal> removals;
  struct Blocked {
    std::size_t part;
    std::vector<std::size_t> by;
    bool is_searched = true;  ///< false: the search for legs ended at its work limit
  };
  std::vector<Blocked> blocked;
};

/// Takes parts off the fixed parts, one after the other. Rules of preference, in this order: no part falls;
/// no allowance for meshes; straight before screws; upwards, along round fits, sideways, down; the direction
/// of the previous removal; the loosest fit (so that pins are in place before the parts that they locate);
/// the highest part; the first part. If no part leaves alone, the smallest set of parts that leaves straight
/// moves as one. If no set leaves straight, the smallest set that leaves along a thread of one of its parts
/// moves as one. Then paths of several legs are searched, of single parts, of parts that turn with all parts
/// that they take along, and then of sets, with work limits for each search and for all. The parts that
/// remain in the end are blocked. Runs on all cores.
/// @param on_removal  called with each removal when the removal is found
Disassembly takeApart(const PairMotions& motions, const std::vector<std::size_t>& members,
                      const std::vector<std::size_t>& fixed, const Progress& progress,
                      const std::function<void(const Removal&)>& on_removal = {});

/// The smallest set of parts without a fixed part that leaves straight, with its direction. Each part and
/// direction gives the set of all parts that this part would push along. Empty if no set leaves.
Removal smallestGroup(const PairMotions& motions, const std::vector<std::size_t>& remaining,
                      const std::vector<std::size_t>& fixed, const Progress& progress);

/// The smallest set of two or more parts without a fixed part that leaves along a thread that `check` found
/// between one of its parts and a part that stays: the screw, and all parts that it takes along. Empty if no
/// set leaves.
Removal screwedGroup(const PairMotions& motions, const std::vector<std::size_t>& remaining,
                     const std::vector<std::size_t>& fixed, const Progress& progress);

/// The parts whose paths groupAlongLegs() tries: connectedGroups() has the groups that need no turn, unless
/// there are too many.
enum class GroupSeeds { OnRoundFits, All };

/// The smallest set of two or more parts without a fixed part that leaves on a path of several legs of one of
/// its parts: the part and all parts that it takes along. The path is searched as if the parts that touch the
/// part, and then as if all parts but the fixed ones, were not there. Empty if no set is found.
/// @param work  by part: limit of the search; receives the work done
Removal groupAlongLegs(const PairMotions& motions, const std::vector<std::size_t>& remaining,
                       const std::vector<std::size_t>& fixed, GroupSeeds seeds, std::vector<SearchWork>& work,
                       const Progress& progress);

/// Limit of the sets of connectedGroups().
inline constexpr std::size_t kMostGroups = 256;
/// Sets of parts without a fixed part, each connected by pairs that are near each other: all sets of two or
/// more parts, smaller sets first, at most kMostGroups sets.
std::vector<std::vector<std::size_t>> connectedGroups(const PairMotions& motions,
                                                      const std::vector<std::size_t>& remaining,
                                                      const std::vector<std::size_t>& fixed);

/// Sort key of directions: up, sideways, down.
int slopeOf(const PairMotions& motions, const Vec3& direction_W);

struct BasePart {
  std::size_t part = 0;
  std::string reason;  ///< why the part was chosen as the base, in words
};

/// Proposes a base among the parts with at least half the volume of the largest part: the part with most
/// neighbours that it touches or fits; among equals the largest part, then the first part. The volume of an
/// open mesh is the volume of its box.
BasePart proposedBase(const PairMotions& motions, const std::vector<std::size_t>& members);

/// @param names  names of the removals, in their order
std::vector<PlannedOrder> precedence(const PairMotions& motions, const Disassembly& apart,
                                     const std::vector<std::string>& names);

/// Removes the orders that follow from other orders by transitivity.
std::vector<PlannedOrder> reducedOrder(const std::vector<PlannedOrder>& order);

}  // namespace vps::scenes
