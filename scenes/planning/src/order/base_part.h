// SPDX-License-Identifier: BSD-3-Clause
// The part on which an assembly is built.
#pragma once

#include <string>
#include <vector>

#include "ways/pair_motions.h"

namespace vps::scenes {

struct BasePart {
  std::size_t part = 0;
  std::string reason;  ///< in words
};

/// Of the parts with at least half the volume of the largest, the one that is in contact or has fits with
/// most others; then the largest; then the first. The volume of an open mesh is that of its box.
BasePart proposedBase(const PairMotions& motions, const std::vector<std::size_t>& members);

}  // namespace vps::scenes
