// SPDX-License-Identifier: BSD-3-Clause
// Maintenance: the procedure backwards. Each part is taken off along the way that it came.
#pragma once

#include "vps_scenes/export.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// The scene with all parts in place and its steps in reverse. Each step takes its part off, along its path
/// from the target to the start, and puts it away there (SceneStep::takes_off); a screw is unscrewed first.
/// Nothing guides a part where its path ends, so its tolerance there is kAway_m, or a quarter of a shorter
/// way; that of the assembly does not apply. Throws LoadError for a scene without a step, for one that is a
/// disassembly, and where no part is fixed.
VPS_SCENES_API Scene disassemblyOf(Scene scene);

/// assumed: nearer than this a part that was put away need not be where its way ends
inline constexpr double kAway_m = 2e-3;

}  // namespace vps::scenes
