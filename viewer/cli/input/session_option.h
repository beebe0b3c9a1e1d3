// SPDX-License-Identifier: BSD-3-Clause
// The option that the nodes share: the name by which they find each other.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "vps_scenes/network/session_network.h"

namespace vps::viewer {

inline constexpr const char* kDefaultSession = "default";

/// Adds --network and --security. Returns the first.
inline CLI::Option* addNetworkOption(CLI::App& command, scenes::SessionNetwork& network) {
  CLI::Option* option = command
                            .add_option("--network", network.interface,
                                        "meet over UDP through this network interface, in place of shared "
                                        "memory; lo: this machine only. Beyond it --security is needed")
                            ->type_name("INTERFACE");
  command
      .add_option("--security", network.security,
                  "folder with this node's certificates (scenes/make_certificates.sh): others can neither "
                  "read nor move anything; none: everybody can who reaches the interface")
      ->type_name("FOLDER")
      ->needs(option);
  return option;
}

/// Adds --session.
inline CLI::Option* addSessionOption(CLI::App& command, std::string& session) {
  return command.add_option("--session", session, "name by which the nodes on this machine find each other")
      ->capture_default_str()
      ->type_name("NAME");
}

}  // namespace vps::viewer
