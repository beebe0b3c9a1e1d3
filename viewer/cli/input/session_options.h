// SPDX-License-Identifier: BSD-3-Clause
// Options of the commands that take part in a session of `vps render`: its name, network and recording.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "vps_scenes/network/session_network.h"
#include "vps_scenes/network/session_recording.h"

namespace vps::viewer {

inline constexpr const char* kDefaultSession = "default";

/// Adds --session.
CLI::Option* addSessionOption(CLI::App& command, std::string& session);
/// Adds --network and --security. Returns the option --network.
CLI::Option* addNetworkOption(CLI::App& command, scenes::SessionNetwork& network);
/// Adds --record, which asks vps render for a recording of the run.
CLI::Option* addRecordOption(CLI::App& command, std::string& file);

/// The settings of a recording that vps render makes and this process receives in `file`.
scenes::SessionRecordingOptions recordingOptions(const std::string& session,
                                                 const scenes::SessionNetwork& network,
                                                 const std::string& file);
/// Waits until vps render has agreed to record. Throws LoadError that names the option if vps render refuses
/// or does not answer.
void requireAsked(scenes::SessionRecording& recording, const std::string& option);
/// Waits for the recording, and prints its file name, or the reason why there is none. Returns an exit
/// status.
int finishRecording(scenes::SessionRecording& recording, const std::string& file);

}  // namespace vps::viewer
