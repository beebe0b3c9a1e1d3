// SPDX-License-Identifier: BSD-3-Clause
// Reads TOML files, with messages for those who wrote them.
#pragma once

#include <string>

#include "scene/scene_file_keys.h"

namespace vps::scenes {

/// @param what, example  for messages: "scene file", "scene.toml"
std::string readTomlText(const std::string& file, const std::string& what, const std::string& example);

/// @param file  for messages
toml::table parseToml(const std::string& text, const std::string& file);

}  // namespace vps::scenes
