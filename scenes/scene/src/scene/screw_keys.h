// SPDX-License-Identifier: BSD-3-Clause
// What a [[step]] with motion = "screw" has to say.
#pragma once

#include "scene/scene_file_keys.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Finds the pitch in the moving part's mesh where the file gives none. Throws LoadError for a screw without
/// a pitch or with a path that turns it, and for keys of a screw elsewhere.
void completeScrew(const SceneKeys& keys, const Mesh& mesh, SceneStep& step);

}  // namespace vps::scenes
