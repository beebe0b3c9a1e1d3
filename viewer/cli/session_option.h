// SPDX-License-Identifier: BSD-3-Clause
// The option that the nodes share: the name by which they find each other.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace vps::viewer::inline v0 {

inline constexpr const char* kDefaultSession = "default";

/// Adds --network.
inline CLI::Option* addNetworkOption(CLI::App& command, std::string& network) {
  return command
      .add_option("--network", network,
                  "meet over UDP through this network interface, in place of shared memory; lo: this machine "
                  "only. Beyond it, whoever reaches the interface can read and move everything")
      ->type_name("INTERFACE");
}

/// Adds --session.
inline CLI::Option* addSessionOption(CLI::App& command, std::string& session) {
  return command.add_option("--session", session, "name by which the nodes on this machine find each other")
      ->capture_default_str()
      ->type_name("NAME");
}

}  // namespace vps::viewer::inline v0
