// SPDX-License-Identifier: BSD-3-Clause
// What kind of file a name stands for, by its extension, for messages that name the right command.
#pragma once

#include <string>

namespace vps::viewer {

/// ".step" of "Part.STEP"; empty if there is none.
std::string lowerExtension(const std::string& file);
/// Whether it is an extension of the formats that vps import reads.
bool isCadExtension(const std::string& lower_extension);

/// Throws LoadError, naming the command that reads the file, unless the file can be a scene.
void requireSceneFile(const std::string& file);
/// Throws LoadError, naming the commands that read the file, unless it can have a mesh.
void requireCadFile(const std::string& file);

}  // namespace vps::viewer
