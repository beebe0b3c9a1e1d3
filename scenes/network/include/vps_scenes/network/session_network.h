// SPDX-License-Identifier: BSD-3-Clause
// Where the nodes of a session meet.
#pragma once

#include <string>
#include <utility>

namespace vps::scenes {

/// The same in all nodes, apart from the folder, which is each node's own.
struct SessionNetwork {
  SessionNetwork() = default;
  SessionNetwork(std::string interface, std::string security = "")
      : interface(std::move(interface)), security(std::move(security)) {}
  SessionNetwork(const char* interface) : interface(interface) {}

  /// In shared memory of one machine, rather than over UDP.
  [[nodiscard]] bool empty() const { return interface.empty(); }
  bool operator==(const SessionNetwork&) const = default;

  std::string interface;  ///< "lo" for this machine only, "eth0"; empty: shared memory
  /// Folder with the certificates of this node, which scenes/make_certificates.sh makes: peers prove who they
  /// are, and all that is sent is encrypted. Empty: on loopback only, whose users trust each other. "none":
  /// whoever reaches the interface can read and move everything.
  std::string security;
};

}  // namespace vps::scenes
