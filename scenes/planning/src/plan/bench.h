// SPDX-License-Identifier: BSD-3-Clause
// Start places of parts on a bench around the assembly.
#pragma once

#include "ways/way_clearance.h"

namespace vps::scenes {

/// Gives each step a start on a bench: a plane below the whole assembly. The parts lie on it in rings around
/// the assembly, in the order of the steps and with the orientation of their starts, with gaps of a twentieth
/// of the assembly's size. From the bench a part is lifted above everything, moved across, and lowered to its
/// original start. The boxes of all starts and of the assembly do not overlap. A step whose part cannot be
/// lowered, because parts in place cover its start on all sides, keeps its start.
void layOnBench(const Placing& placing, PlannedAssembly& assembly);

}  // namespace vps::scenes
