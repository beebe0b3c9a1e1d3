// SPDX-License-Identifier: BSD-3-Clause
// Saves a case as a scene file, which `vps simulate` runs.
#pragma once

#include <filesystem>
#include <string>

#include "case_run.h"

namespace vps::search {

/// Writes scene.toml and an STL file for each body (as the engine got it) into a new folder. The state is
/// the latest one from which the overlap appears without the hand, too; else the one just before it.
/// @param command  repeats the run, hand included; it stands at the top of the scene file
/// @return the scene file. Throws std::runtime_error if a file cannot be written.
std::filesystem::path saveCase(const std::filesystem::path& folder, const Case& made,
                               const RunSettings& settings, const CaseResult& result,
                               const std::string& command);

}  // namespace vps::search
