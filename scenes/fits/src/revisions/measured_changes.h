// SPDX-License-Identifier: BSD-3-Clause
// Differences of the numbers of two checks: pairs, fits and play of parts that both revisions have.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "vps_scenes/fits/revisions.h"

namespace vps::scenes {

/// Which parts of the two revisions are one, by name and index.
struct PartMatches {
  std::unordered_map<std::string, std::size_t> new_of;  ///< by old name: index in the new revision
  std::unordered_map<std::string, std::size_t> old_of;  ///< by new name: index in the old revision
  std::vector<Pose> motion_W;  ///< by index in the new revision: motion of a part that both have
};

std::vector<PairChange> pairChanges(const CheckedAssembly& before, const CheckedAssembly& after,
                                    const PartMatches& matches);
std::vector<FitChange> fitChanges(const CheckedAssembly& before, const CheckedAssembly& after,
                                  const PartMatches& matches);
std::vector<PlayChange> playChanges(const CheckedAssembly& before, const CheckedAssembly& after,
                                    const PartMatches& matches);

}  // namespace vps::scenes
