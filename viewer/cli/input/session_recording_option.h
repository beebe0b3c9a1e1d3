// SPDX-License-Identifier: BSD-3-Clause
// --record of programs that take part in a session of vps render.
#pragma once

#include <string>

#include "output/command.h"
#include "vps_scenes/network/session_recording.h"

namespace vps::viewer {

CLI::Option* addRecordOption(CLI::App& command, std::string& file);
scenes::SessionRecordingOptions recordingOptions(const std::string& session,
                                                 const scenes::SessionNetwork& network,
                                                 const std::string& file);
/// Waits until the wish is granted. Throws LoadError that names the option if it is not.
void requireAsked(scenes::SessionRecording& recording, const std::string& option);
/// Waits for the file, and says where it is, or why not. Returns an exit status.
int finishRecording(scenes::SessionRecording& recording, const std::string& file);

}  // namespace vps::viewer
