// SPDX-License-Identifier: BSD-3-Clause
// Names of requested recordings.
#pragma once

#include <string>

namespace vps::scenes {

/// Whether a name is allowed for a recording: a file name without a folder (the requester must not choose the
/// location on this machine) with letters, digits, -, _ and dots, and the extension .mcap.
bool isRecordingName(const std::string& name);
/// Name under which the render node stores a recording for a file elsewhere: the same name if it is allowed.
std::string recordingName(const std::string& file);

}  // namespace vps::scenes
