// SPDX-License-Identifier: BSD-3-Clause
// Extracts one step of a scene as a scene of its own.
#pragma once

#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// A scene with one step and the parts in place before it: the fixed parts, and the parts of earlier steps,
/// fixed at their targets. Parts of later steps are left out. The virtual operator aims as in the whole
/// scene.
Scene excerptOf(const Scene& scene, std::size_t step);

}  // namespace vps::scenes
