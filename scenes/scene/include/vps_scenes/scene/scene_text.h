// SPDX-License-Identifier: BSD-3-Clause
// Writes scene files, and changes single values of TOML files.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "vps_scenes/cad/import.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// The text of a scene file, in metres, that loadScene() reads as the same scene: each part with its mesh
/// file, and every setting that differs from the default. The function does not write the mesh files.
/// @param files    mesh files of the parts, in the order of the parts, relative to the scene file
/// @param comment  a line at the top
VPS_SCENES_API std::string sceneText(const Scene& scene, const std::vector<std::string>& files,
                                     const std::string& comment);

/// A `[[group]]` of a scene file, with the group's reason as a comment.
VPS_SCENES_API std::string groupText(const PartGroup& group);

/// A text as a TOML basic string.
VPS_SCENES_API std::string tomlText(const std::string& text);
/// A pose as {position = [x, y, z], rotation_xyzw = [x, y, z, w]}, in metres with twelve digits.
VPS_SCENES_API std::string tomlPose(const Pose& pose);

/// A key of one of the file's tables, and its new value as TOML text: {"device", "scale", "0.25"}.
struct TomlValue {
  std::string table, key, value;
};

/// The text of a TOML file in which `values` replace the file's own values; a missing key or table is added.
/// Comments, order and every other byte of the file remain. The result is parsed again to check that it
/// differs from the file in `values` alone. Throws LoadError when the file cannot be read or is not TOML, and
/// when a value is written in a form that this function cannot replace (for example, as a table of its own).
VPS_SCENES_API std::string editedToml(const std::string& file, std::span<const TomlValue> values);

}  // namespace vps::scenes
