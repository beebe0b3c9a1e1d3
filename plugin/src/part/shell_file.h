// SPDX-License-Identifier: BSD-3-Clause
// Pointshells in files of a cache.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "part/cache_file.h"
#include "vps/pointshell.h"

namespace vps {

/// Digest of everything that determines the shell of a mesh's Solid.
Digest shellKeyOf(const Mesh& mesh, const PointShellSettings& settings);
/// Returns nothing, and a reason in `why`, if the file cannot be trusted.
std::optional<PointShell> readShell(const std::filesystem::path& file, const Digest& key, std::string& why);
/// False if the file could not be written.
bool writeShell(const PointShell& shell, const std::filesystem::path& file, const Digest& key);

}  // namespace vps
