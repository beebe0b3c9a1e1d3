// SPDX-License-Identifier: BSD-3-Clause
// The way on which a part leaves the others.
#pragma once

#include <optional>
#include <vector>

#include "vps_scenes/planning/plan_types.h"
#include "ways/pair_motions.h"

namespace vps::scenes {

/// A piece of a way, in the world.
struct Leg {
  Motion motion;
  double s = 0;  ///< how far; of the last leg, which leads away, PairMotions::leave_m()
};

inline constexpr std::size_t kNoDirection = ~std::size_t{0};

/// From home outwards. The last leg is straight.
struct Way {
  WayKind kind = WayKind::Straight;
  std::vector<Leg> legs;
  std::size_t direction = kNoDirection;  ///< of a straight way
  double lead_m = 0;                     ///< of a screw
  double allowance_m = 0;                ///< of a straight way, see PairMotions::allowanceOf()
};

/// The poses at the ends of all legs but the last, as motions of the world: the first is home.
std::vector<Pose> cornersOf(const Way& way);

/// Whether a held part would stop another one on its way.
bool stopsWay(const PairMotions& motions, std::size_t held, std::size_t part, const Way& way);

/// A screw out of a thread of the part's fits with one of the held parts, then straight on.
std::optional<Way> screwWay(const PairMotions& motions, std::size_t part,
                            const std::vector<std::size_t>& held);

/// A way of several legs for parts that move as one, straight along their axes or, of one part, turning about
/// those of its round fits: breadth first, from each place onwards as far as the part goes and to stops
/// between, so that a way of fewest legs is found first. Where `work` is spent it ends. Source: the search
/// over pushes of Tian et al., Assemble Them All, 2022, with exact motions in place of simulated ones. At
/// most 4 legs and 96 places, so that none found is no proof.
std::optional<Way> legWay(const PairMotions& motions, const std::vector<std::size_t>& parts,
                          const std::vector<std::size_t>& held, SearchWork& work);

}  // namespace vps::scenes
