// SPDX-License-Identifier: BSD-3-Clause
// Access control for sessions over UDP: DDS-Security, by the plugins of Cyclone DDS.
#pragma once

#include <string>

#include "vps_scenes/network/session_network.h"

namespace vps::scenes {

/// The part of Cyclone DDS's settings that names certificates and plugins; empty: without security. Throws
/// LoadError if a file or the plugins are missing, or if the network is reachable from other machines and no
/// certificates are given.
std::string securitySettings(const SessionNetwork& network, bool is_loopback);

}  // namespace vps::scenes
