// SPDX-License-Identifier: BSD-3-Clause
// Parts that are moved from their places before a check.
#pragma once

#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/fits/check_types.h"

namespace vps::scenes {

/// Parses a move: "pin,x,0.1mm" (along x, y or z of the assembly), "pin,0:1:1,0.1mm" (along a direction of
/// any length), "pin,rx,2deg" and "pin,r0:1:1,2deg" (about an axis through the part's origin). The name may
/// contain commas. Throws LoadError that begins with `what` and says what is wrong.
/// @param what  for messages: "--move"
VPS_SCENES_API PartMove partMoveFromText(const std::string& text, const std::string& what);

/// Moves the parts, in the order of the moves. The check of the parts repeats the moves in
/// CheckResult::moves. Throws LoadError that begins with `what` if a move names no part of the list; the
/// message offers the nearest name.
VPS_SCENES_API void moveParts(std::vector<DrawnPart>& parts, const std::vector<PartMove>& moves,
                              const std::string& what);

}  // namespace vps::scenes
