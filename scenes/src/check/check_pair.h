// SPDX-License-Identifier: BSD-3-Clause
// Overlap and clearance of two parts.
#pragma once

#include <optional>

#include "check/placed_surface.h"

namespace vps::scenes::inline v0 {

/// Empty if the parts are farther from each other than near_m. Thread-safe.
std::optional<CheckedPair> checkPair(const PlacedSurface& a, const PlacedSurface& b, double near_m);

}  // namespace vps::scenes::inline v0
