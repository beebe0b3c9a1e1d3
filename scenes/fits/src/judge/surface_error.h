// SPDX-License-Identifier: BSD-3-Clause
// How far a part's surface is from where it belongs.
#pragma once

#include "vps/solid.h"

namespace vps::scenes {

/// Greatest distance of a vertex of the displaced part from the surface in place [m]. A displacement that
/// takes the surface into itself, as a round peg's turn about its axis, is none. O(n log n).
/// @param X_error  of the part relative to where it belongs
double surfaceError_m(const Solid& solid, const Pose& X_error);

}  // namespace vps::scenes
