// SPDX-License-Identifier: BSD-3-Clause
// The extensions that a glTF file cannot be read without; assimp 5.2.5 reads such a file as if it had none.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vps::scenes::import {

/// The names under "extensionsRequired" in the JSON text of a glTF file. O(n).
std::vector<std::string> requiredExtensions(std::string_view json);

/// The first of these names that may change geometry and that is not read; empty if there is none. Materials,
/// textures, lights and remarks change none, and compression by Draco is read or refused by assimp.
std::string unreadExtension(const std::vector<std::string>& names);

}  // namespace vps::scenes::import
