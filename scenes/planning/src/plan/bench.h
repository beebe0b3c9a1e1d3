// SPDX-License-Identifier: BSD-3-Clause
// Places where parts lie before they are mounted.
#pragma once

#include "ways/way_clearance.h"

namespace vps::scenes {

/// Gives each step a start on a bench: a plane below all of the assembly, on which the parts, turned as on
/// their ways, lie in rings around it in the order of the steps, with a twentieth of its size between them.
/// From there a part is lifted above everything, moved across, and let down to the start that it had. The
/// boxes of all starts, and of the assembly, are apart. A step whose part cannot be let down, because what is
/// in place covers its start on all sides, keeps that start.
void layOnBench(const Placing& placing, PlannedAssembly& assembly);

}  // namespace vps::scenes
