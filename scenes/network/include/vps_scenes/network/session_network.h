// SPDX-License-Identifier: BSD-3-Clause
// The network of a session.
#pragma once

#include <string>
#include <utility>

namespace vps::scenes {

/// Network of a session; the same in all nodes, apart from the certificate folder, which each node has for
/// itself.
struct SessionNetwork {
  SessionNetwork() = default;
  SessionNetwork(std::string interface, std::string security = "")
      : interface(std::move(interface)), security(std::move(security)) {}
  SessionNetwork(const char* interface) : interface(interface) {}

  /// True if the session uses shared memory of one machine instead of a network. False: UDP.
  [[nodiscard]] bool empty() const { return interface.empty(); }
  bool operator==(const SessionNetwork&) const = default;

  std::string interface;  ///< "lo" for this machine only, "eth0"; empty: shared memory
  /// Folder with the certificates of this node, made by scenes/make_certificates.sh: nodes authenticate each
  /// other, and all data is encrypted. Empty: no security; allowed on loopback only, where users trust each
  /// other. "none": no security on any interface; everybody who can reach it can read and write the session.
  std::string security;
};

}  // namespace vps::scenes
