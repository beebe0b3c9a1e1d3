// SPDX-License-Identifier: BSD-3-Clause
#include "input/session_options.h"

#include <cstdio>

#include "output/command.h"
#include "output/terminal.h"
#include "vps/errors.h"

namespace vps::viewer {

CLI::Option* addNetworkOption(CLI::App& command, scenes::SessionNetwork& network) {
  CLI::Option* option = command
                            .add_option("--network", network.interface,
                                        "communicate over UDP on this network interface instead of shared "
                                        "memory; lo: within this machine. Other interfaces need --security")
                            ->type_name("INTERFACE");
  command
      .add_option("--security", network.security,
                  "folder with this node's certificates (scenes/make_certificates.sh), without which "
                  "nobody can read or move anything; none: everybody who reaches the interface can do both")
      ->type_name("FOLDER")
      ->needs(option);
  return option;
}

CLI::Option* addSessionOption(CLI::App& command, std::string& session) {
  return command.add_option("--session", session, "name by which the nodes on this machine find each other")
      ->capture_default_str()
      ->type_name("NAME");
}

CLI::Option* addRecordOption(CLI::App& command, std::string& file) {
  return command
      .add_option("--record", file,
                  "ask vps render to record the run, and receive the recording when the run has ended "
                  "(MCAP), for vps replay; possible until the run begins")
      ->type_name("FILE.mcap");
}

scenes::SessionRecordingOptions recordingOptions(const std::string& session,
                                                 const scenes::SessionNetwork& network,
                                                 const std::string& file) {
  scenes::SessionRecordingOptions options;
  options.session = session;
  options.network = network;
  options.file = file;
  options.stop = &stopRequested();
  options.say = [](const std::string& words) { say(words); };
  return options;
}

void requireAsked(scenes::SessionRecording& recording, const std::string& option) {
  constexpr double kLimit_s = 8;  // longer than vps render takes to answer
  if (const std::string why = recording.waitUntilAsked(kLimit_s); !why.empty())
    throw LoadError(option, "", why);
}

int finishRecording(scenes::SessionRecording& recording, const std::string& file) {
  const std::string why = recording.finish();
  if (why.empty()) {
    std::printf("recording: %s\n", file.c_str());
    return kGood;
  }
  warn("no recording in " + file + ": " + why);
  return kCouldNot;
}

}  // namespace vps::viewer
