// SPDX-License-Identifier: BSD-3-Clause
// Names of recordings that others ask for.
#pragma once

#include <string>

namespace vps::scenes {

/// Of a file, without a folder, so that nobody chooses where on this machine it goes: letters, digits, -, _
/// and dots, with the ending .mcap.
bool isRecordingName(const std::string& name);
/// Under which the render node keeps what goes to a file elsewhere: the same, where that is allowed.
std::string recordingName(const std::string& file);

}  // namespace vps::scenes
