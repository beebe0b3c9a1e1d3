// SPDX-License-Identifier: BSD-3-Clause
// Precedence between steps, with the reason.
#pragma once

#include "order/take_apart.h"

namespace vps::scenes {

/// @param names  names of the removals, in their order
std::vector<PlannedOrder> precedence(const PairMotions& motions, const Disassembly& apart,
                                     const std::vector<std::string>& names);

/// Removes the orders that follow from other orders by transitivity.
std::vector<PlannedOrder> reducedOrder(const std::vector<PlannedOrder>& order);

}  // namespace vps::scenes
