// SPDX-License-Identifier: BSD-3-Clause
// The fasteners of an assembly, recognised by shape and fits.
#pragma once

#include <optional>
#include <vector>

#include "fits/fastener_shape.h"

namespace vps::scenes {

/// Fasteners recognised by shape (pins only if they fit a bore), and keys: bars with key fits to two parts.
/// @param shapes of the parts, see fastenerShapes()
std::vector<Fastener> fastenersIn(const std::vector<PlacedSurface>& parts, const CheckResult& checked,
                                  const std::vector<std::optional<FastenerShape>>& shapes);

}  // namespace vps::scenes
