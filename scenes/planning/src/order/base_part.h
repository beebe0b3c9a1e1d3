// SPDX-License-Identifier: BSD-3-Clause
// The base part of an assembly, and how it is chosen.
#pragma once

#include <string>
#include <vector>

#include "ways/pair_motions.h"

namespace vps::scenes {

struct BasePart {
  std::size_t part = 0;
  std::string reason;  ///< why it was chosen, in words
};

/// Proposes a base among the parts with at least half the volume of the largest part: the part with most
/// neighbours that it touches or fits; of equals the largest, then the first. The volume of an open mesh is
/// that of its box.
BasePart proposedBase(const PairMotions& motions, const std::vector<std::size_t>& members);

}  // namespace vps::scenes
