// SPDX-License-Identifier: BSD-3-Clause
// The exploded view of a planned assembly.
#pragma once

#include <map>
#include <string>

#include "vps/box.h"
#include "vps_scenes/planning/plan_types.h"

namespace vps::scenes {

/// Displacement of each part in the exploded view. In the order of assembly, the parts of each step move
/// along the last leg of their path until their box has left the boxes of all parts that were placed before;
/// the parts of a subassembly are first moved apart from each other in the same way.
/// @param boxes_W  box of each part at its target
/// @param up_W     direction of a part whose path has no straight last leg
/// O(parts^2).
std::map<std::string, Vec3> explodedView(const PlanResult& plan, const std::map<std::string, Box>& boxes_W,
                                         const Vec3& up_W);

}  // namespace vps::scenes
