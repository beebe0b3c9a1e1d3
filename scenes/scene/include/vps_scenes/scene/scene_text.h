// SPDX-License-Identifier: BSD-3-Clause
// Writes scene files.
#pragma once

#include <string>
#include <vector>

#include "vps_scenes/cad/import.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// The text of a scene file, in metres, that loadScene() reads as the same scene: each part with the mesh
/// file that is named for it, and every setting that is not the default. Meshes are not written.
/// @param files    of the parts, in their order, relative to the scene file
/// @param comment  a line at the top
VPS_SCENES_API std::string sceneText(const Scene& scene, const std::vector<std::string>& files,
                                     const std::string& comment);

/// A `[[group]]` of a scene file, with its reason as a comment.
VPS_SCENES_API std::string groupText(const PartGroup& group);

/// A TOML basic string.
VPS_SCENES_API std::string tomlText(const std::string& text);
/// {position = [x, y, z], rotation_xyzw = [x, y, z, w]}, in metres with twelve digits.
VPS_SCENES_API std::string tomlPose(const Pose& pose);

}  // namespace vps::scenes
