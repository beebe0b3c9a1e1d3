// SPDX-License-Identifier: BSD-3-Clause
// Reads the settings of a scene file that depend on each other: a screw in [[step]], and [fidelity].
#pragma once

#include "scene/scene_file_keys.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Checks a step's keys of a screw, and finds the pitch in the moving part's mesh if the file gives no pitch.
/// Throws LoadError for a screw without a pitch or with a path that rotates the screw, and for keys of a
/// screw in a step without a screw.
void completeScrew(const SceneKeys& keys, const Mesh& mesh, SceneStep& step);

/// Reads `fidelity`: the name of a preset, "auto", or a table of single settings. Without a preset the
/// distance of the points depends on the parts (usualSpacing_m()), so the scene must already have its parts
/// and steps.
/// @param top  keys at the top of the file
void readFidelity(const SceneKeys& top, const SceneFileContext& context, Scene& scene);

}  // namespace vps::scenes
