// SPDX-License-Identifier: BSD-3-Clause
// One step of a scene as a scene of its own.
#pragma once

#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// The step with the parts that are in place by then: fixed parts, and those of earlier steps, fixed at their
/// targets. Parts of later steps are left out. The operator aims as in the whole scene.
Scene excerptOf(const Scene& scene, std::size_t step);

}  // namespace vps::scenes
