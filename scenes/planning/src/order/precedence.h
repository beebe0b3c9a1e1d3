// SPDX-License-Identifier: BSD-3-Clause
// Which step has to come before which, and why.
#pragma once

#include "order/take_apart.h"

namespace vps::scenes {

/// @param names  of the removals, in their order
std::vector<PlannedOrder> precedence(const PairMotions& motions, const Disassembly& apart,
                                     const std::vector<std::string>& names);

/// Those that do not follow from two others.
std::vector<PlannedOrder> reducedOrder(const std::vector<PlannedOrder>& order);

}  // namespace vps::scenes
